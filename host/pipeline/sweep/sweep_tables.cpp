// SPDX-License-Identifier: MIT
#include "pipeline/sweep/sweep_tables.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "basis/sweep.hpp"
#include "support/error.hpp"

namespace clpv {
namespace {

// [finer cells]: float32 rounding of origins about 100 cells away.
constexpr double kAligned = 1e-2;

}  // namespace

std::vector<ClpvSweepBin> sweep_bin_table(int grid) {
  const LinkVolumes links = link_volumes();
  const std::vector<SweepBin> bins = sweep_bins(1);
  std::vector<ClpvSweepBin> table;
  for (const SweepBin& bin : bins) {
    ClpvSweepBin entry{};
    entry.plane_axis = bin.axis, entry.row_axis = bin.v, entry.column_axis = bin.u;
    entry.plane_sign = bin.sign[bin.axis], entry.row_sign = bin.sign[bin.v],
    entry.column_sign = bin.sign[bin.u];
    for (std::size_t k = 0; k < bin.offset.size(); ++k)
      entry.links[k] = links.volume(bin.axis, bin.offset[k]);
    // Volumes across z serve bins across y with plane and row exchanged.
    entry.transposed = bin.axis == 0 ? 1 : 0;
    entry.plane = sweep_plane_size(grid), entry.row = sweep_row_size(grid);
    if (bin.axis == 1) std::swap(entry.plane, entry.row);
    table.push_back(entry);
  }
  return table;
}

std::vector<ClpvSweepDirection> sweep_direction_table(int parts, int coarser_parts) {
  const std::vector<SweepBin> bins = sweep_bins(parts),
                              coarser = sweep_bins(std::max(coarser_parts, 1));
  constexpr double kArea = 0.25;  // area of a finer cell's face, relative to a coarser one's
  std::vector<ClpvSweepDirection> table;
  for (std::size_t b = 0; b < bins.size(); ++b) {
    for (std::size_t part = 0; part < bins[b].directions.size(); ++part) {
      const SweepDirection& d = bins[b].directions[part];
      ClpvSweepDirection entry{};
      for (std::size_t k = 0; k < d.taps.size(); ++k) entry.taps[k] = d.taps[k];
      for (float& channel : entry.attenuation) channel = 1;
      entry.cosine = d.flux;
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

void attenuate(std::vector<ClpvSweepDirection>& table, int parts, const ClpvMedium& medium,
               double cell) {
  std::size_t i = 0;
  for (const SweepBin& bin : sweep_bins(parts)) {
    for (const SweepDirection& d : bin.directions) {
      for (int c = 0; c < 3; ++c)
        table[i].attenuation[c] =
            static_cast<float>(std::exp(-double{medium.extinction[c]} * cell / d.flux));
      ++i;
    }
  }
}

std::vector<float> cells_in_medium(const ClpvMedium& medium, const ClpvGrid& grid) {
  const int n = static_cast<int>(grid.n), pitch = bordered_pitch(n);
  std::vector<float> inside(3 * std::size_t(pitch) + CLPV_SWEEP_FIRST, 0.0f);
  for (int axis = 0; axis < 3; ++axis) {
    for (int i = -1; i <= n; ++i) {
      const double low = grid.origin[axis] + double{grid.cell} * i, high = low + grid.cell;
      const double part =
          std::min(high, double{medium.upper[axis]}) - std::max(low, double{medium.lower[axis]});
      inside[axis * pitch + CLPV_SWEEP_FIRST + i] =
          static_cast<float>(std::clamp(part / grid.cell, 0.0, 1.0));
    }
  }
  return inside;
}

SweepMeans sweep_means(const Basis& basis, int parts) {
  const Matrix means = part_means(basis, parts);
  const int of_bin = parts * parts;
  constexpr int kNone = -1;
  std::vector<std::vector<int>> used(kSweepBins);  // coefficients of each bin
  for (int bin = 0; bin < kSweepBins; ++bin) {
    for (int i = 0; i < basis.size(); ++i) {
      for (int part = 0; part < of_bin; ++part) {
        if (means(bin * of_bin + part, i) == 0) continue;
        used[bin].push_back(i);
        break;
      }
    }
  }
  const auto most = std::ranges::max_element(used, {}, &std::vector<int>::size);
  SweepMeans table{static_cast<int>(most->size()), {}, {}, cosine_rest(basis, means, parts)};
  for (int bin = 0; bin < kSweepBins; ++bin) {
    used[bin].resize(table.emitting, kNone);
    for (const int i : used[bin]) table.coefficients.push_back(i == kNone ? 0 : i);
    for (int part = 0; part < of_bin; ++part) {
      for (const int i : used[bin])
        table.means.push_back(i == kNone ? 0 : means(bin * of_bin + part, i));
    }
  }
  return table;
}

std::array<int, 3> offset_in_coarser(const ClpvGrid& coarser, const ClpvGrid& finer) {
  if (std::abs(coarser.cell / double{finer.cell} - 2) > kAligned) {
    throw Error(ExitCode::run_time, "cascades: cells of {} m in cells of {} m; halves allowed",
                finer.cell, coarser.cell);
  }
  const int most = static_cast<int>(finer.n) + 1;
  std::array<int, 3> offset{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double cells = (double{finer.origin[axis]} - coarser.origin[axis]) / finer.cell;
    const double whole = std::round(cells);
    if (std::abs(cells - whole) > kAligned || whole < -1 || whole > most) {
      throw Error(ExitCode::run_time,
                  "cascades: along axis {} the finer grid starts {} of its cells into the coarser "
                  "one; whole numbers -1..{} allowed",
                  axis, cells, most);
    }
    offset[axis] = whole;
  }
  return offset;
}

}  // namespace clpv
