// SPDX-License-Identifier: MIT
// A device that fails on command: preloaded (LD_PRELOAD) before the OpenCL loader, it passes every
// call on, but for one.
//
//   CLPV_SHIM=CALL:N:CODE    the N-th call (from 1) of clCreateBuffer, ... returns that OpenCL code
//   CLPV_SHIM_COMPILER=no    devices have no compiler
//   CLPV_SHIM_CLOCK=ticks    events have ticks of 42 ns
//   CLPV_SHIM_CLOCK=short    events last 1/42 of their time
//   CLPV_SHIM_CLOCK=late     the same, once a kernel ran; each wait for the queue takes 0.1 s more
//   CLPV_SHIM_CLOCK=swap     events end before they start, once a kernel ran
//   CLPV_SHIM_CLOCK=still    events end when they start, once a kernel ran
//   CLPV_SHIM_REPORT=FILE    at the end: "CALL COUNT" a line, and "live COUNT", memory objects that
//                            were not released
//
// "memory" is a call's name for all that allocate, "enqueue" for launches of kernels from the first
// program on: before it, clpv asks whether the clock of events is to be trusted.
#include <CL/cl.h>
#include <dlfcn.h>

#include <atomic>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <mutex>
#include <string>
#include <thread>

namespace {

using namespace std::chrono_literals;

std::mutex guard;
std::map<std::string, long> calls;
std::map<cl_mem, long> references;
std::atomic<bool> built{false}, kernel_ran{false};

/// Returns true if this call must fail, with the code that it returns instead.
bool fails(const char* kind, const char* name, cl_int& code) {
  if (!built && std::string(kind) == "enqueue") return false;
  const std::lock_guard lock(guard);
  const long of_name = ++calls[name], of_kind = ++calls[kind];
  const char* wish = std::getenv("CLPV_SHIM");
  if (wish == nullptr) return false;
  char which[64] = "", when[16] = "", what[16] = "";
  if (std::sscanf(wish, "%63[^:]:%15[^:]:%15s", which, when, what) != 3) return false;
  const bool by_name = std::string(which) == name, by_kind = std::string(which) == kind;
  if (!by_name && !by_kind) return false;
  if (std::atol(when) != (by_name ? of_name : of_kind)) return false;
  code = std::atoi(what);
  return true;
}

std::string clock_fault() {
  const char* wish = std::getenv("CLPV_SHIM_CLOCK");
  return wish == nullptr ? "" : wish;
}

template <typename Function>
Function next(const char* name) {
  return reinterpret_cast<Function>(::dlsym(RTLD_NEXT, name));
}

cl_mem counted(cl_mem made) {
  const std::lock_guard lock(guard);
  if (made != nullptr) references[made] = 1;
  return made;
}

cl_mem rejected(cl_int* error, cl_int code) {
  if (error != nullptr) *error = code;
  return nullptr;
}

__attribute__((destructor)) void report() {
  const char* file = std::getenv("CLPV_SHIM_REPORT");
  std::FILE* out = file != nullptr ? std::fopen(file, "w") : nullptr;
  if (out == nullptr) return;
  const std::lock_guard lock(guard);
  for (const auto& [name, count] : calls) std::fprintf(out, "%s %ld\n", name.c_str(), count);
  std::fprintf(out, "live %zu\n", references.size());
  std::fclose(out);
}

}  // namespace

#define CLPV_NEXT(name) static const auto call = next<decltype(&name)>(#name)
#define CLPV_MAY_FAIL(kind, name) \
  CLPV_NEXT(name);                \
  cl_int code = CL_SUCCESS;       \
  const bool failed = fails(kind, #name, code)

extern "C" {

cl_int clGetDeviceInfo(cl_device_id device, cl_device_info info, size_t size, void* value,
                       size_t* needed) {
  CLPV_NEXT(clGetDeviceInfo);
  const cl_int code = call(device, info, size, value, needed);
  const bool hidden =
      info == CL_DEVICE_COMPILER_AVAILABLE && std::getenv("CLPV_SHIM_COMPILER") != nullptr;
  if (hidden && code == CL_SUCCESS && value != nullptr) *static_cast<cl_bool*>(value) = CL_FALSE;
  return code;
}

cl_int clGetEventProfilingInfo(cl_event event, cl_profiling_info info, size_t size, void* value,
                               size_t* needed) {
  CLPV_NEXT(clGetEventProfilingInfo);
  const std::string fault = clock_fault();
  const bool still = fault == "still";
  if ((still || fault == "swap") && kernel_ran)
    info = !still && info == CL_PROFILING_COMMAND_START ? CL_PROFILING_COMMAND_END
                                                        : CL_PROFILING_COMMAND_START;
  const cl_int code = call(event, info, size, value, needed);
  if (fault == "ticks" && code == CL_SUCCESS && value != nullptr)
    *static_cast<cl_ulong*>(value) /= 42;
  cl_ulong start = 0;
  if ((fault == "short" || (fault == "late" && kernel_ran)) && info == CL_PROFILING_COMMAND_END &&
      code == CL_SUCCESS && value != nullptr &&
      call(event, CL_PROFILING_COMMAND_START, sizeof start, &start, nullptr) == CL_SUCCESS)
    *static_cast<cl_ulong*>(value) = start + (*static_cast<cl_ulong*>(value) - start) / 42;
  return code;
}

cl_mem clCreateBuffer(cl_context context, cl_mem_flags flags, size_t size, void* host,
                      cl_int* error) {
  CLPV_MAY_FAIL("memory", clCreateBuffer);
  return failed ? rejected(error, code) : counted(call(context, flags, size, host, error));
}

cl_mem clCreateImage(cl_context context, cl_mem_flags flags, const cl_image_format* format,
                     const cl_image_desc* desc, void* host, cl_int* error) {
  CLPV_MAY_FAIL("memory", clCreateImage);
  return failed ? rejected(error, code) : counted(call(context, flags, format, desc, host, error));
}

cl_int clRetainMemObject(cl_mem memory) {
  CLPV_NEXT(clRetainMemObject);
  {
    const std::lock_guard lock(guard);
    ++references[memory];
  }
  return call(memory);
}

cl_int clReleaseMemObject(cl_mem memory) {
  CLPV_NEXT(clReleaseMemObject);
  {
    const std::lock_guard lock(guard);
    if (--references[memory] == 0) references.erase(memory);
  }
  return call(memory);
}

cl_context clCreateContext(const cl_context_properties* properties, cl_uint count,
                           const cl_device_id* devices,
                           void(CL_CALLBACK* notify)(const char*, const void*, size_t, void*),
                           void* user, cl_int* error) {
  CLPV_MAY_FAIL("context", clCreateContext);
  if (!failed) return call(properties, count, devices, notify, user, error);
  if (error != nullptr) *error = code;
  return nullptr;
}

cl_int clBuildProgram(cl_program program, cl_uint count, const cl_device_id* devices,
                      const char* options, void(CL_CALLBACK* notify)(cl_program, void*),
                      void* user) {
  CLPV_MAY_FAIL("build", clBuildProgram);
  built = true;
  return failed ? code : call(program, count, devices, options, notify, user);
}

cl_int clEnqueueNDRangeKernel(cl_command_queue queue, cl_kernel kernel, cl_uint dimensions,
                              const size_t* offset, const size_t* global, const size_t* local,
                              cl_uint waits, const cl_event* events, cl_event* event) {
  CLPV_MAY_FAIL("enqueue", clEnqueueNDRangeKernel);
  kernel_ran = true;
  return failed ? code
                : call(queue, kernel, dimensions, offset, global, local, waits, events, event);
}

cl_int clFinish(cl_command_queue queue) {
  CLPV_NEXT(clFinish);
  const cl_int code = call(queue);
  if (kernel_ran && clock_fault() == "late") std::this_thread::sleep_for(100ms);
  return code;
}

}  // extern "C"
