#include "pipeline/carry_late.hpp"

#include <array>
#include <cmath>

#include "codegen/cell_macros.hpp"
#include "support/error.hpp"

namespace clpv {
namespace {

constexpr double kAligned = 1e-2;  // [finer cells]: rounding of origins in float32, some hundred cells away

/// From the coarser grid's least corner to the finer one's, in finer cells.
std::array<cl_int, 3> offset_between(const ClpvGrid& coarser, const ClpvGrid& finer, int n) {
  if (std::abs(coarser.cell / double{finer.cell} - 2) > kAligned) {
    throw Error(ExitCode::run_time, "late light: cells of {} m in cells of {} m; halves allowed", finer.cell,
                coarser.cell);
  }
  std::array<cl_int, 3> offset{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double cells = (double{finer.origin[axis]} - coarser.origin[axis]) / finer.cell;
    const double whole = std::round(cells);
    if (std::abs(cells - whole) > kAligned || whole < -1 || whole > n + 1) {
      throw Error(
          ExitCode::run_time,
          "late light: along axis {} the finer grid starts {} of its cells into the coarser one; whole "
          "numbers -1..{} allowed",
          axis, cells, n + 1);
    }
    offset[axis] = static_cast<cl_int>(whole);
  }
  return offset;
}

}  // namespace

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
  const std::array<cl_int, 3> offset = offset_between(coarser, finer, shape_.n);
  accumulator_.add(sum, [&](const Volume& so_far, const Volume& next) {
    kernel_.set(light.memory(), so_far.memory(), next.memory(), offset[0], offset[1], offset[2]);
    stencil_.launch(kernel_, shape_.channels);
  });
}

}  // namespace clpv
