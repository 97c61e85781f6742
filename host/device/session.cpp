#include "device/session.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>

#include "device/kernel_files.hpp"
#include "support/error.hpp"

namespace clpv {
namespace {

std::size_t round_up(std::size_t value, std::size_t step) {
  return step == 0 ? value : (value + step - 1) / step * step;
}

std::string full_text(const ProgramSource& source) {
  std::string text;
  for (const auto& [name, value] : source.literals) text += fmt::format("#define {} {}\n", name, value);
  if (!source.generated.empty()) text += "#line 1 \"generated\"\n" + source.generated + "\n";
  return text + assemble_kernel_source(source.file);
}

cl::Program build(cl::Context& context, const Device& device, const ProgramSource& source,
                  const std::string& text) {
  cl::Program program(context, text);
  try {
    program.build(device.handle, source.options.c_str());
  } catch (const cl::Error&) {
    const std::string log = program.getBuildInfo<CL_PROGRAM_BUILD_LOG>(device.handle);
    throw Error(ExitCode::run_time, "kernels/{} does not build on {} ({}) with '{}':\n{}", source.file,
                device.name, device.driver, source.options, log);
  }
  return program;
}

}  // namespace

Session::Session(Device device)
    : device_(std::move(device)),
      context_(device_.handle),
      queue_(context_, device_.handle, device_.profiling_valid ? CL_QUEUE_PROFILING_ENABLE : 0),
      timeline_(device_.profiling_valid) {}

cl::Kernel Session::kernel(const ProgramSource& source, const std::string& name) {
  const std::string text = full_text(source);
  const std::string key = source.options + "\n" + text;
  auto found = programs_.find(key);
  if (found == programs_.end()) {
    const auto start = std::chrono::steady_clock::now();
    found = programs_.emplace(key, build(context_, device_, source, text)).first;
    build_ms_ += std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
  }
  return cl::Kernel(found->second, name.c_str());
}

cl::Buffer Session::buffer(std::size_t bytes, const std::string& what, cl_mem_flags flags) {
  bytes = std::max<std::size_t>(bytes, 4);
  if (bytes > device_.max_alloc_bytes || bytes_ + bytes > device_.memory_bytes) {
    throw Error(ExitCode::run_time,
                "{} needs {} MiB; {} allows {} MiB a buffer and {} MiB in all, {} MiB of them in use", what,
                bytes >> 20, device_.name, device_.max_alloc_bytes >> 20, device_.memory_bytes >> 20,
                bytes_ >> 20);
  }
  cl::Buffer made(context_, flags, bytes);
  bytes_ += bytes;
  return made;
}

void Session::launch(const cl::Kernel& kernel, const cl::NDRange& global, const cl::NDRange& local) {
  const std::size_t* g = global.get();
  const std::size_t* l = local.get();
  cl::NDRange rounded = global;
  if (global.dimensions() == 1) rounded = cl::NDRange(round_up(g[0], l[0]));
  if (global.dimensions() == 2) rounded = cl::NDRange(round_up(g[0], l[0]), round_up(g[1], l[1]));
  if (global.dimensions() == 3) {
    rounded = cl::NDRange(round_up(g[0], l[0]), round_up(g[1], l[1]), round_up(g[2], l[2]));
  }
  cl::Event event;
  queue_.enqueueNDRangeKernel(kernel, cl::NullRange, rounded, local, nullptr, &event);
  timeline_.add(event);
}

void Session::fill_zero(const cl::Buffer& buffer, std::size_t bytes) {
  cl::Event event;
  queue_.enqueueFillBuffer(buffer, cl_uint{0}, 0, bytes, nullptr, &event);
  timeline_.add(event);
}

void Session::copy(const cl::Buffer& from, const cl::Buffer& to, std::size_t bytes) {
  cl::Event event;
  queue_.enqueueCopyBuffer(from, to, 0, 0, bytes, nullptr, &event);
  timeline_.add(event);
}

}  // namespace clpv
