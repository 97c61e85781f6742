// SPDX-License-Identifier: MIT
#include "codegen/sweep_source.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "codegen/cell_macros.hpp"
#include "codegen/linear_code.hpp"
#include "codegen/mirrors.hpp"
#include "codegen/transmit_source.hpp"

namespace clpv {
namespace {

constexpr int kLanes = 8;
constexpr std::size_t kLine = 32;  // between planes, and volumes
constexpr const char* kAxisNames = "XYZ";

int place_in(const std::vector<glm::ivec3>& list, const glm::ivec3& offset) {
  return static_cast<int>(std::find(list.begin(), list.end(), offset) - list.begin());
}

/// Offsets of the ways: as sweep_ways numbers them, and for each axis those that directions across it use.
struct WayList {
  std::vector<glm::ivec3> all;
  std::array<std::vector<glm::ivec3>, 3> across;

  /// The number of the volume that a kernel keeps a way in: x's first.
  int volume(int axis, const glm::ivec3& offset) const {
    int before = 0;
    for (int i = 0; i < axis; ++i) before += static_cast<int>(across[static_cast<std::size_t>(i)].size());
    return before + place_in(across[static_cast<std::size_t>(axis)], offset);
  }
};

WayList way_list() {
  WayList list;
  for (const auto& way : sweep_ways()) list.all.push_back(way.offset);
  for (const SweepBin& bin : sweep_bins(1)) {
    auto& across = list.across[static_cast<std::size_t>(bin.axis)];
    for (const glm::ivec3& offset : bin.offset) {
      if (std::find(across.begin(), across.end(), offset) == across.end()) across.push_back(offset);
    }
  }
  return list;
}

std::string way_macros() {
  const WayList list = way_list();
  std::string text = fmt::format("#define CLPV_X_WAYS {}\n", list.across[0].size());
  for (int axis = 0; axis < 3; ++axis) {
    text += fmt::format("#define CLPV_EACH_{}_WAY(DO)", kAxisNames[axis]);
    for (const glm::ivec3& offset : list.across[static_cast<std::size_t>(axis)])
      text += fmt::format(" DO({}, {})", list.volume(axis, offset), place_in(list.all, offset));
    text += "\n";
  }
  return text;
}

std::size_t row_numbers(int grid) {
  return static_cast<std::size_t>((grid + kLanes - 1) / kLanes * kLanes);
}

std::size_t of_volume_plane(int grid) {
  return static_cast<std::size_t>(grid) * row_numbers(grid) + kLine;
}

/// Where the first cell's source is among a volume's numbers, and how far it is to the next channel, plane and row.
void put_source(ClpvSweepBin& entry, std::size_t b, const SweepBin& bin, int grid,
                const VolumeFormat& injected) {
  const VolumeShape shape{grid, kSweepBins, 3};
  const auto at = [&](int channel, const glm::ivec3& cell) {
    return static_cast<int>(
        stored_index(injected, shape, channel, static_cast<int>(b), cell.x, cell.y, cell.z));
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

std::string sweep_bin_macros() {
  const std::vector<SweepBin> bins = sweep_bins(1);
  std::string text =
      fmt::format("#define CLPV_X_BINS {}\n",
                  std::count_if(bins.begin(), bins.end(), [](const SweepBin& bin) { return bin.axis == 0; }));
  for (int axis = 0; axis < 3; ++axis) {
    text += fmt::format("#define CLPV_EACH_{}_BIN(DO)", kAxisNames[axis]);
    for (std::size_t b = 0; b < bins.size(); ++b) {
      if (bins[b].axis == axis) text += fmt::format(" DO({})", b);
    }
    text += "\n";
  }
  return text;
}

CountedText sweep_source_text(const Basis& basis) {
  const Mirrors mirrors = mirrors_of(basis);
  LinearCode code;
  const std::vector<std::string> means =
      code.product(bin_means(basis), fields("a", basis.size()), {mirrors.all.begin(), mirrors.all.end()});
  std::string text =
      coefficient_macros(basis.size()) + sweep_bin_macros() + cell_macros("Swept", "SWEPT", kSweepBins) +
      "CLPV_INLINE Swept clpv_bin_means(const Coefficients a) {\n" + code.text() + "  Swept m;\n";
  for (std::size_t i = 0; i < means.size(); ++i) text += fmt::format("  m.c{} = {};\n", i, means[i]);
  return {text + "  return m;\n}\n", code.operations()};
}

std::string sweep_ways_text(const Basis& basis, const Transport& transport) {
  return transmit_source(basis, transport).text + way_macros();
}

CountedText sweep_collect_text() {
  const Matrix projection = swept_projection();
  const Mirrors mirrors = mirrors_of(*make_basis("bins24"));
  LinearCode code;
  const std::vector<std::string> harmonics =
      code.product(projection, fields("m", kSweepBins), {mirrors.all.begin(), mirrors.all.end()});
  std::string text =
      coefficient_macros(projection.rows()) + sweep_bin_macros() + cell_macros("Swept", "SWEPT", kSweepBins) +
      "CLPV_INLINE Coefficients clpv_projected(const Swept m) {\n" + code.text() + "  Coefficients c;\n";
  for (std::size_t i = 0; i < harmonics.size(); ++i) text += fmt::format("  c.c{} = {};\n", i, harmonics[i]);
  return {text + "  return c;\n}\n", code.operations()};
}

std::size_t sweep_plane_numbers(int grid) {
  return static_cast<std::size_t>(grid + 2) * (row_numbers(grid) + kLanes) + kLanes;
}

std::size_t sweep_volume_numbers(int grid) {
  return static_cast<std::size_t>(grid) * of_volume_plane(grid) + kLine;
}

std::size_t sweep_bordered_numbers(int grid) {
  return static_cast<std::size_t>(grid + 2) * sweep_plane_numbers(grid);
}

int sweep_way_count() {
  const WayList list = way_list();
  return static_cast<int>(list.across[0].size() + list.across[1].size() + list.across[2].size());
}

bool swept_in_place(const Basis& basis, const VolumeFormat& injected) {
  return injected.layout == Layout::soa && holds_bin_means(basis);
}

std::vector<ClpvSweepBin> sweep_bin_table(int grid, const std::optional<VolumeFormat>& injected) {
  const WayList list = way_list();
  const std::vector<SweepBin> bins = sweep_bins(1);
  std::vector<ClpvSweepBin> table;
  for (std::size_t b = 0; b < bins.size(); ++b) {
    const SweepBin& bin = bins[b];
    ClpvSweepBin entry{};
    entry.plane_axis = bin.axis, entry.row_axis = bin.v, entry.column_axis = bin.u;
    entry.plane_sign = bin.sign[bin.axis], entry.row_sign = bin.sign[bin.v],
    entry.column_sign = bin.sign[bin.u];
    for (std::size_t k = 0; k < bin.offset.size(); ++k) entry.ways[k] = list.volume(bin.axis, bin.offset[k]);
    const auto volume = static_cast<int>(sweep_volume_numbers(grid));
    entry.source = static_cast<int>(b) * volume, entry.channel = kSweepBins * volume;
    entry.plane = static_cast<int>(of_volume_plane(grid)), entry.row = static_cast<int>(row_numbers(grid));
    if (injected && bin.axis == 2) put_source(entry, b, bin, grid, *injected);
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
