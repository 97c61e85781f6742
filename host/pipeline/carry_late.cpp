// SPDX-License-Identifier: MIT
#include "pipeline/carry_late.hpp"

#include <array>

#include "codegen/cell_macros.hpp"
#include "pipeline/cascade.hpp"

namespace clpv {

LateCarrier::LateCarrier(Session& session, const VolumeShape& shape, const VolumeFormat& format, int lanes)
    : shape_(shape),
      stencil_(session.device(),
               {.grid = shape.n,
                .format = format,
                .lanes = lanes > 0 ? lanes : preferred_row_lanes(session.device(), format)}),
      kernel_(session, {"carry_late.cl", stencil_.literals(), coefficient_macros(shape.coefficients)},
              "carry_late"),
      accumulator_(session) {}

void LateCarrier::carry(const Volume& light, const ClpvGrid& coarser, Volume& sum, const ClpvGrid& finer) {
  const std::array<int, 3> offset = offset_in_coarser(coarser, finer);
  accumulator_.add(sum, [&](const Volume& so_far, const Volume& next) {
    kernel_.set(light.memory(), so_far.memory(), next.memory(), offset[0], offset[1], offset[2]);
    stencil_.launch(kernel_, shape_.channels);
  });
}

}  // namespace clpv
