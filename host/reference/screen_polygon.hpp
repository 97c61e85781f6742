// SPDX-License-Identifier: MIT
// A triangle on the screen, in double: clipped, snapped, and what pixels it covers.
#pragma once

#include <array>
#include <glm/glm.hpp>
#include <vector>

#include "kernels/shared/view.h"

namespace clpv::reference {

/// Which pixel centres a triangle covers, by the rasteriser's rules.
class ScreenPolygon {
 public:
  /// `corners` in the world [m]. Cut at the near plane where the view is a perspective one.
  ScreenPolygon(const ClpvView& view, const std::array<glm::dvec3, 3>& corners);

  bool covers(unsigned px, unsigned py) const;
  /// From the pixel's centre to the nearest edge [pixels].
  double distance_to_edge(unsigned px, unsigned py) const;
  /// Whether it shows its front: counter-clockwise on the screen.
  bool faces_viewer() const { return front_; }
  double nearest() const { return nearest_; }    ///< least depth of its corners [m]
  double farthest() const { return farthest_; }  ///< greatest depth of its corners [m]
  bool empty() const { return corners_.empty(); }

 private:
  std::vector<glm::dvec2> corners_;  // [1/256 pixel], y down
  bool front_ = false;
  double nearest_ = 0, farthest_ = 0;
};

}  // namespace clpv::reference
