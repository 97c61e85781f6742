// SPDX-License-Identifier: MIT
// The light that a frame's volumes hold, at points that no camera need see.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "device/session.hpp"
#include "pipeline/frame.hpp"
#include "reference/gather.hpp"

namespace clpv {

/// What the volumes held after a frame's last render, read back; gathered on the host, in double, as the frame gathers for
/// what its camera sees.
class LightField {
 public:
  /// Throws Error(usage) for a frame that has not rendered yet. Refers to the frame's basis, but takes no note of its next
  /// render. Takes 8 bytes of the host's memory for each number of the volumes.
  LightField(Session& session, const Frame& frame);

  /// Indirect irradiance [W/m^2] of red, green, blue on a surface at `position` [m] with unit `normal`; 0 outside all
  /// cascades.
  glm::dvec3 irradiance(const glm::dvec3& position, const glm::dvec3& normal) const;

  /// Whether `position` lies in the coarsest cascade.
  bool reaches(const glm::dvec3& position) const;

 private:
  const Basis& basis_;
  TransportKind transport_;
  GatherOptions options_;
  std::vector<reference::Volume> volumes_;
  std::vector<std::uint8_t> occluded_;  ///< empty where all cells light a surface
  std::vector<reference::Cascade> cascades_;
};

}  // namespace clpv
