// SPDX-License-Identifier: MIT
// Light of a frame's volumes at arbitrary points, visible to the camera or not.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <string>
#include <vector>

#include "device/session.hpp"
#include "pipeline/frame.hpp"
#include "reference/gather.hpp"

namespace clpv {

/// Host copy of the volumes after a frame's last render. Gathers light in double precision, with the method the frame
/// uses for its camera.
class LightField {
 public:
  /// Throws Error(usage) for a frame that has not rendered yet. Refers to the frame's basis; later renders do not
  /// update the copy. Uses 8 bytes of host memory per volume coefficient.
  LightField(Session& session, const Frame& frame);

  /// Indirect irradiance [W/m^2] (red, green, blue) on a surface at `position` [m] with unit `normal`; 0 outside all
  /// cascades.
  glm::dvec3 irradiance(const glm::dvec3& position, const glm::dvec3& normal) const;

  /// Returns true if `position` lies in the coarsest cascade.
  bool reaches(const glm::dvec3& position) const;

 private:
  const Basis& basis_;
  TransportKind transport_;
  GatherOptions options_;
  std::vector<reference::Volume> volumes_;
  std::vector<std::uint8_t> occluded_;  ///< empty if all cells light surfaces
  std::vector<reference::Cascade> cascades_;
};

/// Returns the share of the visible surfaces' pixels that no cascade of the last render reaches: they have no indirect
/// light. 0 without a surface.
double unreached_share(Session& session, const Frame& frame);

/// Warns above 0.1 %.
void warn_of_unreached(Session& session, const Frame& frame, const std::string& camera);

}  // namespace clpv
