// Setting all arguments of a kernel at once.
#pragma once

#include <CL/opencl.hpp>

namespace clpv {

/// Sets arguments 0, 1, ... of `kernel`: buffers, and values of exactly the parameter's type.
template <typename... Arguments>
void set_arguments(cl::Kernel& kernel, const Arguments&... arguments) {
  cl_uint index = 0;
  (kernel.setArg(index++, arguments), ...);
}

}  // namespace clpv
