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
#ifdef FMT_VERSION
#error "a public header includes fmt"
#endif
