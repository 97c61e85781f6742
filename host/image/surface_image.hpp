// SPDX-License-Identifier: MIT
// What a view sees, on the host: an RSM or the camera's G-buffer. Knows no OpenCL.
#pragma once

#include <glm/glm.hpp>
#include <vector>

#include "kernels/shared/view.h"

namespace clpv {

static_assert(sizeof(ClpvView) == CLPV_SIZEOF_VIEW);

/// One value a pixel, row 0 first: a Surface (pipeline/surface.hpp) read back, or made by a test. What the CPU references of
/// host/reference work on. Depth [m] along the view's forward axis, 0: no surface there; normals and colours as Surface's.
struct SurfaceImage {
  ClpvView view{};
  std::vector<float> depth;
  std::vector<glm::vec4> normal, colour, emissive;  ///< xyz; w unused
  std::vector<glm::vec4> position = {};             ///< [m], of points that no view sees: in place of depth
};

}  // namespace clpv
