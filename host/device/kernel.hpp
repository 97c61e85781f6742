// SPDX-License-Identifier: MIT
// A kernel as an object: described when it is made, built when it is first needed, launched with typed arguments.
#pragma once

#include <CL/opencl.hpp>
#include <concepts>
#include <memory>
#include <string>
#include <type_traits>

#include "device/memory.hpp"
#include "device/program.hpp"

namespace clpv {

class Session;
struct Program;

/// What a kernel takes by value, in exactly the parameter's type: kernels have no parameters of type bool or double, nor
/// integers of 64 bits.
template <typename T>
concept KernelValue = std::is_trivially_copyable_v<T> && !std::is_pointer_v<T> && !std::same_as<T, bool> &&
                      !std::same_as<T, double> && !(std::integral<T> && sizeof(T) > sizeof(cl_uint));

/// And memory, where a parameter is a pointer or an image.
template <typename T>
concept KernelMemory =
    std::derived_from<T, cl::Memory> || std::same_as<T, Buffer> || std::same_as<T, Image3D>;

template <typename T>
concept KernelArgument = KernelValue<T> || KernelMemory<T>;

class Kernel {
 public:
  /// The kernel `name` of a program that is not built yet: Session::build_described(), or the first arguments, do that.
  Kernel(Session& session, const ProgramSource& source, std::string name);

  /// Sets the arguments from the first one on; add() goes on where they end.
  template <KernelArgument... Arguments>
  Kernel& set(const Arguments&... arguments) {
    given_ = 0;
    return add(arguments...);
  }
  /// The arguments that follow: those that only some forms of a kernel have come last.
  template <KernelArgument... Arguments>
  Kernel& add(const Arguments&... arguments) {
    (built().setArg(given_++, as_cl(arguments)), ...);
    return *this;
  }

  /// Session::launch() with the arguments set since the last set(). Throws Error(run_time) where these are not all.
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
  cl::Kernel& built();

  Session* session_;
  std::shared_ptr<Program> program_;
  std::string name_;
  cl::Kernel kernel_;
  cl_uint parameters_ = 0, given_ = 0;
};

}  // namespace clpv
