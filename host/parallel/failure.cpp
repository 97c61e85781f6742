// SPDX-License-Identifier: MIT
#include "parallel/failure.hpp"

#include <CL/opencl.hpp>
#include <exception>
#include <new>

#include "device/cl_error.hpp"

namespace clpv {

Failure current_failure() {
  try {
    throw;
  } catch (const Error& error) {
    return {error.code(), error.what()};
  } catch (const cl::Error& error) {
    const Error named = cl_error(error);
    return {named.code(), named.what()};
  } catch (const std::bad_alloc&) {
    return {ExitCode::run_time, "out of memory"};
  } catch (const std::exception& error) {
    return {ExitCode::run_time, error.what()};
  }
}

}  // namespace clpv
