// SPDX-License-Identifier: MIT
// OpenCL kernel, built on first use and launched with typed arguments.
#pragma once

#include <CL/opencl.hpp>
#include <concepts>
#include <cstddef>
#include <memory>
#include <span>
#include <string>
#include <type_traits>
#include <vector>

#include "device/memory.hpp"
#include "device/program.hpp"
#include "device/session.hpp"
#include "device/timeline.hpp"

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
  Kernel(Kernel&&) = default;  // a copy would set arguments unknown to the other one
  Kernel& operator=(Kernel&&) = default;

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
    const HostPart part(host().arguments_ms);
    (set_next(arguments), ...);
    return *this;
  }

  /// Session::launch() with the arguments set so far. Throws Error(run_time) if arguments are
  /// missing. Waits for the first launch, which compiles on some drivers.
  void launch(const cl::NDRange& global, const cl::NDRange& local, Chain chain = {});

 private:
  /// Drivers copy all arguments of a kernel at each launch, and calls that set them are slow on
  /// some: those that did not change are left.
  template <typename T>
  void set_next(const T& argument) {
    if constexpr (std::derived_from<T, cl::Memory>) {  // another one may have the same handle
      set_changed(argument);
    } else if (const auto bytes = std::as_bytes(std::span(&argument, 1)); changes(bytes)) {
      set_changed(argument);
    }
    ++argument_count_;
  }
  template <typename Handle>
  void set_next(const DeviceMemory<Handle>& memory) {
    const std::uint64_t number = memory.number();
    if (changes(std::as_bytes(std::span(&number, 1)))) set_changed(memory.handle());
    ++argument_count_;
  }
  template <typename T>
  void set_changed(const T& argument) {
    built().setArg(argument_count_, argument);
    ++host().arguments;
    if constexpr (std::derived_from<T, cl::Memory>)
      record(argument);
    else
      record(std::as_bytes(std::span(&argument, 1)));
  }
  /// Notes the next argument's value, and returns true if it was another.
  bool changes(std::span<const std::byte> value);
  HostWork& host() const;
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
  std::vector<std::vector<std::byte>> values_;  ///< bytes of the arguments set last
};

// Prefix sums of numbers on the device (kernels/prefix_sum.cl).

/// Exclusive prefix sum of uints, in place.
class PrefixSum {
 public:
  explicit PrefixSum(Session& session);

  /// Replaces the first `count` values, at least one, by the sums of those before them. Value
  /// `count`, which the buffer has as well, and `total` (uint) become the sum of all.
  void run(const Buffer& values, std::size_t count, const Buffer& total);

 private:
  Session& session_;
  Kernel sum_blocks_, place_blocks_;
  Buffer totals_;
};

}  // namespace clpv
