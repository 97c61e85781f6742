// SPDX-License-Identifier: MIT
// CPU reference of stage `gather` (kernels/gather/gather.cl): irradiance from light volumes, in
// double (docs/method.md, 'Gathering').
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "basis/basis.hpp"
#include "basis/transport.hpp"
#include "image/image.hpp"
#include "kernels/shared/grid.h"
#include "options/stage_options.hpp"
#include "reference/volume.hpp"

namespace clpv::reference {

/// Light of one cascade.
struct Cascade {
  ClpvGrid grid{};
  const Volume* accumulated = nullptr;  ///< for swept light: channel 3 is its white furnace
  /// Bits of visibility_masks(); required if GatherOptions::gather is `visible`.
  const std::uint8_t* occluded = nullptr;
};

/// A way [m] from a point on which nothing stands, or 0, and a direction towards the eye.
struct ClearWay {
  glm::dvec3 way{0}, eye{0};
  ClearWay() = default;
  ClearWay(const glm::dvec3& towards_eye) : way(towards_eye), eye(towards_eye) {}
  ClearWay(const glm::dvec3& along, const glm::dvec3& towards_eye) : way(along), eye(towards_eye) {}
};

/// Returns the irradiance [W/m^2] in red, green, blue of a surface at `position` [m] with unit
/// `normal`. `cascades`: finest first. `clear`: sample_of().
glm::dvec3 gather(const Basis& basis, TransportKind transport, const GatherOptions& options,
                  const std::vector<Cascade>& cascades, const glm::dvec3& position,
                  const glm::dvec3& normal, const glm::dvec3& lift, const ClearWay& clear = {});

/// Returns true if rounding decides which sample points count in a lookup of gather() or
/// radiance_field().
bool rounding_decides(const GatherOptions& options, const std::vector<Cascade>& cascades,
                      const glm::dvec3& position, double offset, const glm::dvec3& lift,
                      const ClearWay& clear);

/// Returns the irradiance of every `every`-th pixel of a G-buffer, row 0 first; 0 where it shows no
/// surface.
std::vector<glm::dvec3> gather(const Basis& basis, TransportKind transport,
                               const GatherOptions& options, const std::vector<Cascade>& cascades,
                               const SurfaceImage& camera, std::size_t every = 1);

}  // namespace clpv::reference
