// SPDX-License-Identifier: MIT
// Stage `gather` in double: the CPU reference of kernels/gather.cl.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "basis/basis.hpp"
#include "basis/transport.hpp"
#include "image/surface_image.hpp"
#include "kernels/shared/grid.h"
#include "options/stage_options.hpp"
#include "reference/volume.hpp"

namespace clpv::reference {

/// A cascade's light as gathering reads it.
struct Cascade {
  ClpvGrid grid{};
  const Volume* accumulated = nullptr;
  const std::uint8_t* hidden =
      nullptr;  ///< as CellVisibility keeps it, where GatherOptions::gather is `visible`
};

/// Irradiance [W/m^2] of red, green, blue that the cascades, finest first, put on a surface at `position` [m]
/// with unit `normal`. As Gatherer, one surface at a time.
glm::dvec3 gather(const Basis& basis, TransportKind transport, const GatherOptions& options,
                  const std::vector<Cascade>& cascades, const glm::dvec3& position, const glm::dvec3& normal);

/// The same for every pixel of what a camera sees, row 0 first; 0 where there is no surface.
std::vector<glm::dvec3> gather(const Basis& basis, TransportKind transport, const GatherOptions& options,
                               const std::vector<Cascade>& cascades, const SurfaceImage& camera);

}  // namespace clpv::reference
