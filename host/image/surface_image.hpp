// SPDX-License-Identifier: MIT
// RSM or G-buffer on the host. Does not depend on OpenCL.
#pragma once

#include <glm/glm.hpp>
#include <vector>

#include "kernels/shared/view.h"

namespace clpv {

/// Host copy of a Surface (pipeline/raster/surface.hpp), input of the CPU reference. One value per
/// pixel, row 0 first. Depth [m] is along the view's forward axis, 0 without a surface; normals and
/// colours are as in Surface.
struct SurfaceImage {
  ClpvView view{};
  std::vector<float> depth;
  std::vector<glm::vec4> normal, colour, emissive;  ///< xyz; w unused
  std::vector<glm::vec4> position = {};  ///< [m], in place of depth for points without a view
};

}  // namespace clpv
