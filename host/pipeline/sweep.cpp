// SPDX-License-Identifier: MIT
#include "pipeline/sweep.hpp"

#include <algorithm>
#include <array>
#include <utility>

#include "basis/sweep.hpp"
#include "codegen/sweep_source.hpp"
#include "pipeline/cascade.hpp"
#include "support/error.hpp"

namespace clpv {
namespace {

constexpr std::size_t kRowGroup = 64;  // work-items of a row, on devices of many

std::size_t number_bytes(const VolumeFormat& format) {
  return format.storage == Storage::float16 ? 2 : 4;
}

std::size_t squared(int parts) {
  return static_cast<std::size_t>(parts) * static_cast<std::size_t>(parts);
}

std::size_t directions_of(int parts) {
  return kSweepBins * squared(parts);
}

Buffer zeroed(Session& session, std::size_t bytes, const char* what) {
  const std::size_t words = (bytes + sizeof(cl_uint) - 1) / sizeof(cl_uint) * sizeof(cl_uint);
  Buffer buffer = session.buffer(words, what);
  session.fill_zero(buffer, words);
  return buffer;
}

/// The coarser cells that a finer cascade's border is made of, `offset` finer cells from the coarser grid's least corner.
ClpvSweepShell shell_of(int grid, const std::array<int, 3>& offset) {
  const auto lower = [](int u) { return (u - 1) >> 1; };  // of the two coarser cells round a finer one
  ClpvSweepShell shell{};
  shell.side = (grid + 1) / 2 + 3;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    shell.first[axis] = lower(offset[axis] - 1);
    shell.layers[2 * axis] = lower(offset[axis] - 1);
    shell.layers[2 * axis + 1] = lower(offset[axis] + grid);
  }
  return shell;
}

std::size_t shell_numbers(int grid) {
  const auto side = static_cast<std::size_t>((grid + 1) / 2 + 3);
  return 2 * side * ((side + 7) / 8 * 8 + 8) + 8;
}

/// Of what a cascade keeps for the next finer one.
std::size_t shell_bytes(const SweepOptions& options, std::size_t cascade) {
  if (cascade == 0) return sizeof(float);
  return 3 * 3 * directions_of(options.parts[cascade]) * shell_numbers(options.grid) *
         number_bytes(options.format);
}

bool within(const ClpvSweepShell& shell, int grid) {
  return std::all_of(shell.first, shell.first + 3,
                     [&](int first) { return first >= 0 && first + shell.side <= grid; });
}

ProgramSource tiled_program(const char* file, const SweepOptions& options, int tile, std::string generated) {
  ProgramSource source{file, {}, std::move(generated)};
  source.literals.integer("CLPV_GRID", options.grid);
  add_format_literals(source.literals, options.format, tile);
  return source;
}

ProgramSource sweep_program(const SweepOptions& options, int parts, bool whole_bins) {
  ProgramSource source{"sweep.cl", {}, {}};
  source.literals.integer("CLPV_GRID", options.grid)
      .integer("CLPV_PARTS", squared(parts))
      .flag("CLPV_BLOCKING", options.blocking)
      .flag("CLPV_WHOLE_BINS", whole_bins);
  add_format_literals(source.literals, options.format, whole_bins ? 8 : 1);
  return source;
}

ProgramSource border_program(const SweepOptions& options, int parts, int coarser_parts) {
  ProgramSource source{"sweep_border.cl", {}, {}};
  source.literals.integer("CLPV_GRID", options.grid)
      .integer("CLPV_PARTS", squared(parts))
      .integer("CLPV_COARSER_PARTS", squared(coarser_parts));
  add_format_literals(source.literals, options.format, 8);
  return source;
}

}  // namespace

double Sweeper::bytes(const SweepOptions& options) {
  const auto number = static_cast<double>(number_bytes(options.format));
  const auto volume = static_cast<double>(sweep_volume_numbers(options.grid)) * number;
  const auto plane = static_cast<double>(sweep_plane_numbers(options.grid));
  double most = 0, shells = 0;
  for (std::size_t c = 0; c < options.parts.size(); ++c) {
    most = std::max(most, static_cast<double>(3 * directions_of(options.parts[c])));
    shells += static_cast<double>(shell_bytes(options, c));
  }
  const double ways = options.blocking ? static_cast<double>(options.parts.size()) * sweep_way_count() : 0;
  return (3 * kSweepBins + ways) * volume + most * 2 * plane * (sizeof(float) + number) + shells;
}

Sweeper::Sweeper(Session& session, const Basis& basis, const Transport& transport,
                 const SweepOptions& options)
    : session_(session),
      options_(options),
      tile_(preferred_row_lanes(session.device(), options.format)),
      source_(session, tiled_program("sweep_source.cl", options, tile_, sweep_source_text(basis)),
              "sweep_source"),
      collect_(session, tiled_program("sweep_collect.cl", options, tile_, sweep_collect_text()),
               "sweep_collect") {
  const std::size_t volume = sweep_volume_numbers(options.grid) * number_bytes(options.format);
  const std::size_t plane = sweep_plane_numbers(options.grid) * sizeof(float);
  const std::size_t swept = 3 * directions_of(*std::max_element(options.parts.begin(), options.parts.end()));
  bins_ = session.upload(sweep_bin_table(), "bins to sweep");
  light_ = zeroed(session, 3 * kSweepBins * volume, "light to sweep, and swept");
  live_ = zeroed(session, (whole_bins() ? 1 : 2) * swept * plane, "planes being swept");
  border_ = zeroed(session, 2 * swept * sweep_plane_numbers(options.grid) * number_bytes(options.format),
                   "light at the border");
  if (options.blocking) {
    ways_.emplace(session, tiled_program("sweep_ways.cl", options, tile_, sweep_ways_text(basis, transport)),
                  "sweep_ways");
  }
  for (std::size_t c = 0; c < options.parts.size(); ++c) passes_.push_back(make_pass(c));
}

bool Sweeper::whole_bins() const {
  return options_.form == SweepForm::bins ||
         (options_.form == SweepForm::suited && session_.device().type == "cpu");
}

Sweeper::Pass Sweeper::make_pass(std::size_t cascade) {
  const int parts = options_.parts[cascade];
  const int coarser = cascade + 1 < options_.parts.size() ? options_.parts[cascade + 1] : 0;
  const std::size_t volume = sweep_volume_numbers(options_.grid) * number_bytes(options_.format);
  Pass pass{parts,
            session_.upload(sweep_direction_table(parts, coarser), "directions to sweep"),
            zeroed(session_,
                   options_.blocking ? static_cast<std::size_t>(sweep_way_count()) * volume : sizeof(float),
                   "transmittance to sweep through"),
            Kernel(session_, sweep_program(options_, parts, whole_bins()),
                   whole_bins() ? "sweep_bin" : "sweep_plane"),
            {},
            zeroed(session_, shell_bytes(options_, cascade), "light for a finer cascade")};
  if (coarser > 0) pass.let_in.emplace(session_, border_program(options_, parts, coarser), "sweep_border");
  return pass;
}

void Sweeper::launch_tiles(Kernel& kernel, int channels) {
  const auto tiles = static_cast<std::size_t>((options_.grid + tile_ - 1) / tile_);
  const auto slices = static_cast<std::size_t>(options_.grid) * static_cast<std::size_t>(channels);
  kernel.launch({tiles, tiles, slices}, {tile_ == 1 ? std::min(tiles, kRowGroup) : 1, 1, 1});
}

void Sweeper::block(std::size_t cascade, const Volume& geometry) {
  ways_.value().set(geometry.memory(), passes_[cascade].ways);
  launch_tiles(*ways_, 1);
}

void Sweeper::let_in(std::size_t cascade, const std::vector<ClpvGrid>& grids) {
  Pass& pass = passes_[cascade];
  if (!pass.let_in) {
    session_.fill_zero(border_, border_.bytes());
    session_.fill_zero(live_, live_.bytes());
    return;
  }
  const std::size_t swept = 3 * directions_of(pass.parts);
  // Planes of odd number have their own place, and the one before the first is of them.
  const std::size_t before = whole_bins() ? 0 : swept * sweep_plane_numbers(options_.grid);
  const std::array<int, 3> offset = offset_in_coarser(grids[cascade + 1], grids[cascade]);
  pass.let_in->set(bins_, pass.directions, passes_[cascade + 1].shell, shell_of(options_.grid, offset),
                   offset[0], offset[1], offset[2], live_, static_cast<cl_int>(before), border_);
  const auto rows = static_cast<std::size_t>(options_.grid) + 2;
  pass.let_in->launch({(rows + 7) / 8, rows, 3 * swept}, {1, std::min(rows, kRowGroup), 1});
}

ClpvSweepShell Sweeper::shell(std::size_t cascade, const std::vector<ClpvGrid>& grids) const {
  if (cascade == 0) return {};
  return shell_of(options_.grid, offset_in_coarser(grids[cascade], grids[cascade - 1]));
}

void Sweeper::sweep(Pass& pass, const ClpvSweepShell& shell) {
  pass.sweep.set(bins_, pass.directions, light_, pass.ways, border_, shell, live_, pass.shell);
  if (whole_bins()) {
    pass.sweep.launch({kSweepBins}, {1});
    return;
  }
  const auto n = static_cast<std::size_t>(options_.grid);
  for (int plane = 0; plane < options_.grid; ++plane) {
    pass.sweep.set(bins_, pass.directions, light_, pass.ways, border_, shell, live_, pass.shell, plane);
    pass.sweep.launch({n, n, kSweepBins}, {std::min(n, kRowGroup), 1, 1});
  }
}

void Sweeper::sweep(std::size_t cascade, const std::vector<ClpvGrid>& grids, const Volume& injected,
                    Volume& accumulated) {
  source_.set(injected.memory(), light_);
  launch_tiles(source_, 3);
  let_in(cascade, grids);
  Pass& pass = passes_[cascade];
  const ClpvSweepShell kept = shell(cascade, grids);
  // What lies beyond this grid is dark.
  if (!within(kept, options_.grid)) session_.fill_zero(pass.shell, pass.shell.bytes());
  sweep(pass, kept);
  collect_.set(light_, accumulated.memory());
  launch_tiles(collect_, 3);
}

}  // namespace clpv
