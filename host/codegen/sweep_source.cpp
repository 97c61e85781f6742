// SPDX-License-Identifier: MIT
#include "codegen/sweep_source.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "codegen/cell_macros.hpp"
#include "codegen/linear_code.hpp"
#include "codegen/mirrors.hpp"
#include "codegen/transmit_source.hpp"

namespace clpv {
namespace {

constexpr int kLanes = 8;
constexpr int kTurnedAxis = 0;  // of planes whose rows lie along y

/// Bins 0 .. turned - 1 are those of directions across x.
int turned_bins(const std::vector<SweepBin>& bins) {
  return static_cast<int>(
      std::count_if(bins.begin(), bins.end(), [](const SweepBin& b) { return b.axis == kTurnedAxis; }));
}

std::string bin_macros() {
  const int turned = turned_bins(sweep_bins(1));
  std::string text =
      fmt::format("#define CLPV_SWEEP_BINS {}\n#define CLPV_TURNED_BINS {}\n", kSweepBins, turned);
  std::string lists[2] = {"#define CLPV_EACH_TURNED_BIN(DO)", "#define CLPV_EACH_STRAIGHT_BIN(DO)"};
  for (int b = 0; b < kSweepBins; ++b) lists[b < turned ? 0 : 1] += fmt::format(" DO({})", b);
  return text + lists[0] + "\n" + lists[1] + "\n";
}

/// Offsets of the ways as sweep_ways numbers them, and as kernels keep them: straight ones, then turned ones.
struct WayList {
  std::vector<glm::ivec3> all, straight, turned;
};

WayList way_list() {
  WayList list;
  for (const auto& way : sweep_ways().neighbours) list.all.push_back(way.offset);
  const std::vector<SweepBin> bins = sweep_bins(1);
  for (const glm::ivec3& offset : list.all) {
    const auto used = [&](bool turned) {
      return std::any_of(bins.begin(), bins.end(), [&](const SweepBin& bin) {
        return (bin.axis == kTurnedAxis) == turned &&
               std::find(bin.offset.begin(), bin.offset.end(), offset) != bin.offset.end();
      });
    };
    if (used(false)) list.straight.push_back(offset);
    if (used(true)) list.turned.push_back(offset);
  }
  return list;
}

int place_in(const std::vector<glm::ivec3>& list, const glm::ivec3& offset) {
  return static_cast<int>(std::find(list.begin(), list.end(), offset) - list.begin());
}

std::string each_way(const char* name, const WayList& list, const std::vector<glm::ivec3>& kept) {
  std::string text =
      fmt::format("#define CLPV_{}_WAYS {}\n#define CLPV_EACH_{}_WAY(DO)", name, kept.size(), name);
  for (std::size_t i = 0; i < kept.size(); ++i)
    text += fmt::format(" DO({}, {})", i, place_in(list.all, kept[i]));
  return text + "\n";
}

std::size_t pitch(int grid) {
  return static_cast<std::size_t>((grid + kLanes - 1) / kLanes * kLanes + kLanes);
}

}  // namespace

std::string sweep_source_text(const Basis& basis) {
  const Mirrors mirrors = mirrors_of(basis);
  LinearCode code;
  const std::vector<std::string> means =
      code.product(bin_means(basis), fields("a", basis.size()), {mirrors.all.begin(), mirrors.all.end()});
  std::string text =
      coefficient_macros(basis.size()) + bin_macros() + cell_macros("Swept", "SWEPT", kSweepBins) +
      "CLPV_INLINE Swept clpv_bin_means(const Coefficients a) {\n" + code.text() + "  Swept m;\n";
  for (std::size_t i = 0; i < means.size(); ++i) text += fmt::format("  m.c{} = {};\n", i, means[i]);
  return text + "  return m;\n}\n";
}

std::string sweep_ways_text(const Basis& basis, const Transport& transport) {
  const WayList list = way_list();
  return transmit_source(basis, transport).text + each_way("STRAIGHT", list, list.straight) +
         each_way("TURNED", list, list.turned);
}

std::string sweep_collect_text() {
  return coefficient_macros(kSweepBins) + bin_macros();
}

std::size_t sweep_plane_numbers(int grid) {
  return static_cast<std::size_t>(grid + 2) * pitch(grid) + kLanes;
}

std::size_t sweep_volume_numbers(int grid) {
  const auto rows = static_cast<std::size_t>(grid + 2);
  return rows * rows * pitch(grid) + kLanes;
}

int sweep_way_count() {
  const WayList list = way_list();
  return static_cast<int>(list.straight.size() + list.turned.size());
}

std::vector<ClpvSweepBin> sweep_bin_table(int grid) {
  const WayList list = way_list();
  const int row = static_cast<int>(pitch(grid)), slice = (grid + 2) * row;
  std::vector<ClpvSweepBin> table;
  for (const SweepBin& bin : sweep_bins(1)) {
    ClpvSweepBin entry{};
    // Slices lie along z; planes across z are slices, all others hold a row of each slice.
    const bool slices = bin.axis == 2;
    entry.plane_step = slices ? slice : row;
    entry.row_step = slices ? row : slice;
    entry.plane_axis = bin.axis, entry.row_axis = bin.v, entry.column_axis = bin.u;
    entry.plane_sign = bin.sign[bin.axis], entry.row_sign = bin.sign[bin.v],
    entry.column_sign = bin.sign[bin.u];
    for (std::size_t k = 0; k < bin.offset.size(); ++k) {
      entry.ways[k] = bin.axis == kTurnedAxis
                          ? static_cast<int>(list.straight.size()) + place_in(list.turned, bin.offset[k])
                          : place_in(list.straight, bin.offset[k]);
    }
    table.push_back(entry);
  }
  return table;
}

std::vector<ClpvSweepDirection> sweep_direction_table(int parts, int coarser_parts) {
  const std::vector<SweepBin> bins = sweep_bins(parts), coarser = sweep_bins(std::max(coarser_parts, 1));
  constexpr double kArea = 0.25;  // of a finer cell's face, of a coarser one's
  std::vector<ClpvSweepDirection> table;
  for (std::size_t b = 0; b < bins.size(); ++b) {
    for (std::size_t part = 0; part < bins[b].directions.size(); ++part) {
      const SweepDirection& d = bins[b].directions[part];
      ClpvSweepDirection entry{};
      for (std::size_t k = 0; k < d.taps.size(); ++k) entry.taps[k] = static_cast<float>(d.taps[k]);
      entry.share = static_cast<float>(d.solid_angle / (d.flux * bins[b].solid_angle));
      if (coarser_parts > 0) {
        entry.coarser = coarser_part(static_cast<int>(part), parts, coarser_parts);
        const SweepDirection& from = coarser[b].directions[static_cast<std::size_t>(entry.coarser)];
        entry.from_coarser = static_cast<float>(kArea * d.flux / from.flux);
      }
      table.push_back(entry);
    }
  }
  return table;
}

}  // namespace clpv
