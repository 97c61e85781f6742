// SPDX-License-Identifier: MIT
// OpenCL kernel, built on first use and launched with typed arguments.
#pragma once

#include <CL/opencl.hpp>
#include <concepts>
#include <memory>
#include <span>
#include <string>
#include <type_traits>

#include "device/memory.hpp"
#include "device/program.hpp"

namespace clpv {

class Session;
struct Program;

/// Kernel argument passed by value, in exactly the parameter's type. Kernels have no parameters of
/// type bool, double or 64-bit integer.
template <typename T>
concept KernelValue =
    std::is_trivially_copyable_v<T> && !std::is_pointer_v<T> && !std::same_as<T, bool> &&
    !std::same_as<T, double> && !(std::integral<T> && sizeof(T) > sizeof(cl_uint));

/// Kernel argument for a parameter that is a pointer or an image.
template <typename T>
concept KernelMemory =
    std::derived_from<T, cl::Memory> || std::same_as<T, Buffer> || std::same_as<T, Image3D>;

template <typename T>
concept KernelArgument = KernelValue<T> || KernelMemory<T>;

/// One kernel function of a program, with its arguments.
class Kernel {
 public:
  /// Describes the kernel `name`. Programs::build_described() or the first set() builds its
  /// program.
  Kernel(Session& session, const ProgramSource& source, std::string name);

  /// Sets arguments from the first parameter on.
  template <KernelArgument... Arguments>
  Kernel& set(const Arguments&... arguments) {
    argument_count_ = 0;
    return add(arguments...);
  }
  /// Sets the arguments that follow. Parameters that only some variants of a kernel have come last.
  template <KernelArgument... Arguments>
  Kernel& add(const Arguments&... arguments) {
    if (!claimed()) return *this;
    (set_next(as_cl(arguments)), ...);
    return *this;
  }

  /// Session::launch() with the arguments set so far. Throws Error(run_time) if arguments are
  /// missing. Waits for the first launch, which compiles on some drivers.
  void launch(const cl::NDRange& global, const cl::NDRange& local);

 private:
  template <typename T>
  static const T& as_cl(const T& argument) {
    return argument;
  }
  template <typename Handle>
  static const Handle& as_cl(const DeviceMemory<Handle>& memory) {
    return memory.handle();
  }
  template <typename T>
  void set_next(const T& argument) {
    built().setArg(argument_count_, argument);
    if constexpr (std::derived_from<T, cl::Memory>)
      record(argument);
    else
      record(std::as_bytes(std::span(&argument, 1)));
    ++argument_count_;
  }
  /// Adds the argument to the session's recording.
  void record(const cl::Memory& memory);
  void record(std::span<const std::byte> value);
  cl::Kernel& built();
  bool claimed() const;  ///< Programs::claims

  Session* session_;
  std::shared_ptr<Program> program_;
  std::string name_;
  cl::Kernel kernel_;
  cl_uint parameter_count_ = 0, argument_count_ = 0;
};

}  // namespace clpv
