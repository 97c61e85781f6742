// SPDX-License-Identifier: MIT
// All public headers, and none of the settings that the library itself is compiled with.
#include <clpv/compare.hpp>
#include <clpv/device.hpp>
#include <clpv/error.hpp>
#include <clpv/image.hpp>
#include <clpv/log.hpp>
#include <clpv/mesh.hpp>
#include <clpv/opencl.hpp>
#include <clpv/options.hpp>
#include <clpv/pathtrace.hpp>
#include <clpv/renderer.hpp>
#include <clpv/scene.hpp>
#include <clpv/version.hpp>

#if defined(CL_HPP_ENABLE_EXCEPTIONS) || defined(CL_HPP_TARGET_OPENCL_VERSION) || \
    defined(GLM_FORCE_EXPLICIT_CTOR)
#error "clpv::clpv changes how its users are compiled"
#endif
// Members may be left out.
clpv::TraceOptions traced() {
  return {.width = 3};
}
clpv::Camera seen() {
  return {.eye = {0, 1, 3}};
}
clpv::GBuffer surfaces() {
  return {.width = 1, .height = 1};
}
clpv::Mesh mesh() {
  return {.smooth = true};
}
#ifdef FMT_VERSION
#error "a public header includes fmt"
#endif
