// SPDX-License-Identifier: MIT
// A triangle projected on the screen: clipping, snapping and coverage tests, in double.
#pragma once

#include <array>
#include <glm/glm.hpp>
#include <vector>

#include "kernels/shared/view.h"

namespace clpv::reference {

/// Coverage of pixel centres by a triangle: corners snapped to 1/256 pixel, top-left rule.
class ScreenPolygon {
 public:
  /// `corners` in world space [m]. Clipped at the near plane in perspective views.
  ScreenPolygon(const ClpvView& view, const std::array<glm::dvec3, 3>& corners);

  bool covers(unsigned px, unsigned py) const;
  /// Distance from the pixel's centre to the nearest edge [pixels].
  double distance_to_edge(unsigned px, unsigned py) const;
  /// Returns true if the front faces the viewer: counter-clockwise on the screen.
  bool faces_viewer() const { return front_; }
  double nearest() const { return nearest_; }    ///< minimum depth of its corners [m]
  double farthest() const { return farthest_; }  ///< maximum depth of its corners [m]
  bool empty() const { return corners_.empty(); }

 private:
  std::vector<glm::dvec2> corners_;  // [1/256 pixel], y down
  bool front_ = false;
  double nearest_ = 0, farthest_ = 0;
};

}  // namespace clpv::reference
