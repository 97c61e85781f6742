// SPDX-License-Identifier: MIT
#include "pipeline/sweep_tables.hpp"

#include <algorithm>

#include "basis/sweep.hpp"

namespace clpv {
namespace {

/// Stores the index of the first cell's source in a volume, and the strides to the next channel, plane and row.
void put_source(ClpvSweepBin& entry, std::size_t b, const SweepBin& bin, int grid,
                const VolumeFormat& injected) {
  const VolumeShape shape{grid, kSweepBins, 3};
  const auto at = [&](int channel, const glm::ivec3& cell) -> int {
    return stored_index(injected, shape, channel, static_cast<int>(b), cell.x, cell.y, cell.z);
  };
  const auto along = [](int axis) {
    glm::ivec3 step(0);
    step[axis] = 1;
    return step;
  };
  entry.injected = 1;
  entry.source = at(0, {});
  entry.channel = at(1, {}) - entry.source;
  entry.plane = at(0, along(bin.axis)) - entry.source;
  entry.row = at(0, along(bin.v)) - entry.source;
}

}  // namespace

bool swept_in_place(const Basis& basis, const VolumeFormat& injected) {
  return injected.layout == Layout::soa && holds_bin_means(basis);
}

std::vector<ClpvSweepBin> sweep_bin_table(int grid, const std::optional<VolumeFormat>& injected) {
  const LinkVolumes links = link_volumes();
  const std::vector<SweepBin> bins = sweep_bins(1);
  std::vector<ClpvSweepBin> table;
  for (std::size_t b = 0; b < bins.size(); ++b) {
    const SweepBin& bin = bins[b];
    ClpvSweepBin entry{};
    entry.plane_axis = bin.axis, entry.row_axis = bin.v, entry.column_axis = bin.u;
    entry.plane_sign = bin.sign[bin.axis], entry.row_sign = bin.sign[bin.v],
    entry.column_sign = bin.sign[bin.u];
    for (std::size_t k = 0; k < bin.offset.size(); ++k)
      entry.links[k] = links.volume(bin.axis, bin.offset[k]);
    const int volume = CLPV_SWEEP_VOLUME_OF(grid);
    entry.source = static_cast<int>(b) * volume, entry.channel = kSweepBins * volume;
    entry.plane = CLPV_SWEEP_PLANE_OF(grid), entry.row = CLPV_SWEEP_ROW_OF(grid);
    if (injected && bin.axis == 2) put_source(entry, b, bin, grid, *injected);
    table.push_back(entry);
  }
  return table;
}

std::vector<ClpvSweepDirection> sweep_direction_table(int parts, int coarser_parts) {
  const std::vector<SweepBin> bins = sweep_bins(parts), coarser = sweep_bins(std::max(coarser_parts, 1));
  constexpr double kArea = 0.25;  // area of a finer cell's face, relative to a coarser one's
  std::vector<ClpvSweepDirection> table;
  for (std::size_t b = 0; b < bins.size(); ++b) {
    for (std::size_t part = 0; part < bins[b].directions.size(); ++part) {
      const SweepDirection& d = bins[b].directions[part];
      ClpvSweepDirection entry{};
      for (std::size_t k = 0; k < d.taps.size(); ++k) entry.taps[k] = d.taps[k];
      entry.share = d.solid_angle / (d.flux * bins[b].solid_angle);
      if (coarser_parts > 0) {
        entry.coarser = coarser_part(static_cast<int>(part), parts, coarser_parts);
        const SweepDirection& from = coarser[b].directions[entry.coarser];
        entry.from_coarser = kArea * d.flux / from.flux;
      }
      table.push_back(entry);
    }
  }
  return table;
}

}  // namespace clpv
