// SPDX-License-Identifier: MIT
#include "pipeline/sweep/sweep.hpp"

#include <algorithm>
#include <array>
#include <utility>

#include "basis/bounce.hpp"
#include "basis/sky_light.hpp"
#include "basis/sweep.hpp"
#include "codegen/linear_code.hpp"
#include "codegen/sweep_source.hpp"
#include "pipeline/frame/cascade.hpp"
#include "pipeline/sweep/sweep_tables.hpp"
#include "support/error.hpp"

namespace clpv {
namespace {

constexpr int kBounceParts = 1;  // parts of a bin, squared, in sweeps for bounces

std::size_t directions_of(int parts) {
  return kSweepBins * parts * parts;
}

/// Numbers of one plane buffer.
std::size_t plane_numbers(int grid) {
  return CLPV_SWEEP_BORDERED_PLANE_OF(std::size_t(grid));
}

/// Coarser cells that the border of a finer cascade interpolates. `offset`: offset_in_coarser().
ClpvSweepHalo halo_of(int grid, const std::array<int, 3>& offset) {
  const auto lower = [](int u) { return (u - 1) >> 1; };  // CLPV_LOWER of kernels/sweep/coarse_to_fine.h
  ClpvSweepHalo halo{};
  halo.side = CLPV_SWEEP_HALO_SIDE_OF(grid);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    halo.first[axis] = lower(offset[axis] - 1);
    halo.layers[2 * axis] = lower(offset[axis] - 1);
    halo.layers[2 * axis + 1] = lower(offset[axis] + grid);
  }
  return halo;
}

/// Bytes of the halo light that a cascade stores for the next finer one.
std::size_t halo_bytes(const SweepOptions& options, int parts, std::size_t cascade) {
  if (cascade == 0) return sizeof(float);
  const std::size_t side = CLPV_SWEEP_HALO_SIDE_OF(options.grid);
  return 3 * 3 * directions_of(parts) * CLPV_SWEEP_HALO_FACE_OF(side) * number_bytes(options.format.storage);
}

bool within(const ClpvSweepHalo& halo, int grid) {
  return std::all_of(halo.first, halo.first + 3,
                     [&](int first) { return first >= 0 && first + halo.side <= grid; });
}

/// Kernels that set the boundary condition of a cascade whose bins have parts^2 parts.
ProgramSource border_program(const char* file, const SweepOptions& options, int parts) {
  ProgramSource source{file, {}, {}};
  source.literals.integer("CLPV_GRID", options.grid).integer("CLPV_PARTS", parts * parts);
  add_format_literals(source.literals, options.format, 8);
  return source;
}

}  // namespace

Sweeper::Sweeper(Session& session, const Basis& basis, const Transport& transport,
                 const SweepOptions& options)
    : session_(session),
      options_(options),
      volumes_(session, options.grid, options.format),
      source_(session, volumes_.program("sweep/sweep_source.cl", coefficient_macros(basis.size())), "sweep_source"),
      collect_(session, volumes_.program("sweep/sweep_collect.cl", sweep_collect_text().text), "sweep_collect") {
  const std::size_t plane = plane_numbers(options.grid) * sizeof(float);
  const std::size_t ordinates =
      3 * directions_of(*std::max_element(options.parts.begin(), options.parts.end()));
  bins_ = session.upload(sweep_bin_table(options.grid), "bins to sweep");
  sources_ = volumes_.make(2 * 3 * basis.size(), "sources of the sweep");
  lit_ = zeroed_buffer(session, 2 * CLPV_SWEEP_VOLUME_OF(std::size_t(options.grid)) / volumes_.lanes(),
                       "lit rows of the sweep");
  sums_ = volumes_.make(3 * kSweepBins, "sums of the sweep");
  plane_buffer_ =
      zeroed_buffer(session, (whole_bins() ? 1 : 2) * ordinates * plane, "plane buffer of the sweep");
  border_ = zeroed_buffer(session,
                          2 * ordinates * plane_numbers(options.grid) * number_bytes(options.format.storage),
                          "boundary condition of the sweep");
  if (options.blocking)
    transmittance_.emplace(session, volumes_.program("sweep/sweep_links.cl", sweep_links_text(basis, transport)),
                           "sweep_links");
  const std::size_t links = options.blocking ? link_volumes().count() : 1;
  for (std::size_t c = 0; c < options.parts.size(); ++c)
    links_.push_back(volumes_.make(links, "transmittance of the sweep's links"));
  passes_ = make_passes(basis, options.parts);
  if (options.medium) medium_.emplace(session, volumes_, *options.medium, options.grid, options.parts.size());
  if (options.bounces == Bounces::one) return;
  bouncer_.emplace(session, basis, options);
  bounced_ = std::make_unique<Volume>(session, VolumeShape{options.grid, basis.size(), 3},
                                      "injected and reflected light", options.format);
  const bool all = options.bounces == Bounces::all;
  bounce_passes_ =
      make_passes(basis, std::vector<int>(all && !scatters() ? 1 : options.parts.size(), kBounceParts));
  if (!all) return;
  first_swept_ = volumes_.make(3 * kSweepBins, "light of the first bounce");
  ProgramSource collecting =
      volumes_.program("sweep/sweep_collect.cl", sweep_collect_text().text + incident_flux_text());
  collecting.literals.flag("CLPV_WITH_INCIDENT", true);
  collect_with_incident_.emplace(session, collecting, "sweep_collect");
}

/// Program of sweep_bins.cl or sweep_planes.cl, for light of `coefficients`, of which a bin depends on `emitting`.
ProgramSource Sweeper::sweep_program(int coefficients, int emitting, int parts) const {
  ProgramSource source{whole_bins() ? "sweep/sweep_bins.cl" : "sweep/sweep_planes.cl", {}, {}};
  source.literals.integer("CLPV_GRID", options_.grid)
      .integer("CLPV_PARTS", parts * parts)
      .integer("CLPV_SOURCES", coefficients)
      .integer("CLPV_EMITTING", emitting)
      .integer("CLPV_SOURCE_LANES", volumes_.lanes())
      .flag("CLPV_BLOCKING", options_.blocking)
      .flag("CLPV_MEDIUM", options_.medium.has_value());
  add_format_literals(source.literals, options_.format, whole_bins() ? 8 : 1);
  return source;
}

bool Sweeper::scatters() const {
  return medium_ && medium_->scatters();
}

bool Sweeper::whole_bins() const {
  return options_.form == SweepForm::bins ||
         (options_.form == SweepForm::suited && session_.device().type == "cpu");
}

Sweeper::Passes Sweeper::make_passes(const Basis& basis, const std::vector<int>& parts) {
  Passes passes;
  for (std::size_t c = 0; c < parts.size(); ++c) {
    const int coarser = c + 1 < parts.size() ? parts[c + 1] : 0;
    const SweepMeans means = sweep_means(basis, parts[c]);
    Pass pass{parts[c],
              coarser,
              session_.upload(sweep_direction_table(parts[c], coarser), "directions to sweep"),
              session_.upload(means.coefficients, "coefficients of the sweep's bins"),
              session_.upload(means.means, "means of the basis's functions"),
              Kernel(session_, sweep_program(basis.size(), means.emitting, parts[c]),
                     whole_bins() ? "sweep_bin" : "sweep_plane"),
              {},
              zeroed_buffer(session_, halo_bytes(options_, parts[c], c), "boundary light of a finer cascade"),
              {},
              {}};
    if (coarser > 0) {
      ProgramSource border = border_program("sweep/sweep_border.cl", options_, parts[c]);
      border.literals.integer("CLPV_COARSER_PARTS", coarser * coarser);
      pass.border.emplace(session_, border, "sweep_border");
    }
    passes.push_back(std::move(pass));
  }
  return passes;
}

void Sweeper::set_medium(std::size_t cascade, const ClpvGrid& grid, const std::vector<ShadowedLight>& lights,
                         float scale) {
  if (!medium_) return;
  const auto attenuate_in = [&](const Pass& pass) {
    std::vector<ClpvSweepDirection> table = sweep_direction_table(pass.parts, pass.coarser);
    attenuate(table, pass.parts, medium_->medium(), double{grid.cell});
    session_.write(pass.directions, table);
  };
  attenuate_in(passes_[cascade]);
  // The coarsest cascade alone may have a pass for bounces.
  const std::size_t first = options_.parts.size() - bounce_passes_.size();
  if (cascade >= first) attenuate_in(bounce_passes_[cascade - first]);
  medium_->place(cascade, grid);
  medium_->scatter_lights(grid, lights, scale);
  scattered_swept_ = false;
}

void Sweeper::set_blockers(std::size_t cascade, const Volume& geometry) {
  transmittance_.value().set(geometry.memory(), links_[cascade]);
  volumes_.launch(*transmittance_, 1);
}

void Sweeper::set_reflectors(std::size_t cascade, const Volume& reflectors) {
  bouncer_.value().set_reflectors(cascade, reflectors);
  if (options_.bounces != Bounces::all || scatters() || cascade + 1 < options_.parts.size()) return;
  for (int bounce = 0; bounce < kFurtherBounces; ++bounce) {
    bouncer_->inject_unit(*bounced_);
    set_sources(*bounced_);
    launch(bounce_passes_.back(), cascade, sums_, {}, false);
    bouncer_->extend_series(sums_);
  }
}

void Sweeper::set_sky(const Sky& sky) {
  for (Passes* passes : {&passes_, &bounce_passes_}) {
    if (passes->empty()) continue;
    Pass& coarsest = passes->back();
    coarsest.sky = session_.upload(swept_sky(sky, coarsest.parts), "boundary light of the sky");
    coarsest.sky_border.emplace(session_, border_program("sweep/sweep_sky.cl", options_, coarsest.parts),
                                "sweep_sky");
  }
}

/// Returns the index of the plane upstream of the grid in the plane buffer. A sweep by planes uses the odd planes.
cl_int Sweeper::upstream_plane(const Pass& pass) const {
  return whole_bins() ? 0 : 3 * directions_of(pass.parts) * plane_numbers(options_.grid);
}

void Sweeper::launch_border(Kernel& kernel, const Pass& pass) {
  const std::size_t rows = options_.grid + 2;
  kernel.launch({(rows + 7) / 8, rows, 9 * directions_of(pass.parts)}, {1, std::min(rows, kRowGroup), 1});
}

/// Sets the boundary condition of the coarsest cascade, with cells of edge `cell` [m], from the sky. Returns false,
/// and sets nothing, without a sky.
bool Sweeper::set_boundary(Pass& coarsest, float cell) {
  if (!coarsest.sky_border) return false;
  coarsest.sky_border->set(coarsest.sky, sky_scale_ * (cell * cell), plane_buffer_, upstream_plane(coarsest),
                           border_);
  launch_border(*coarsest.sky_border, coarsest);
  return true;
}

/// Sets the boundary condition of a cascade from the next coarser one, or from the sky. Returns false, and sets
/// nothing, if no light enters.
bool Sweeper::set_boundary(Passes& passes, std::size_t cascade, const std::vector<ClpvGrid>& grids) {
  Pass& pass = passes[cascade];
  if (!pass.border) return set_boundary(pass, grids[cascade].cell);
  const std::array<int, 3> offset = offset_in_coarser(grids[cascade + 1], grids[cascade]);
  pass.border->set(bins_, pass.directions, passes[cascade + 1].halo_light, halo_of(options_.grid, offset),
                   offset[0], offset[1], offset[2], plane_buffer_, upstream_plane(pass), border_);
  launch_border(*pass.border, pass);
  return true;
}

ClpvSweepHalo Sweeper::halo(std::size_t cascade, const std::vector<ClpvGrid>& grids) const {
  if (cascade == 0) return {};
  return halo_of(options_.grid, offset_in_coarser(grids[cascade], grids[cascade - 1]));
}

/// Sets the light that the next sweeps inject.
void Sweeper::set_sources(const Volume& light) {
  source_.set(light.memory(), sources_, lit_);
  volumes_.launch(source_, 1);
}

/// Launches the sweep of a cascade. `lit`: set_boundary() has set light at the border.
void Sweeper::launch(Pass& pass, std::size_t cascade, const Buffer& sums, const ClpvSweepHalo& halo,
                     bool lit) {
  const auto set = [&](cl_int last) {
    pass.sweep.set(bins_, pass.directions, pass.coefficients, pass.means, sources_, lit_, links_[cascade],
                   border_, halo, plane_buffer_, sums, pass.halo_light, last);
    if (medium_) medium_->add_to(pass.sweep, cascade, scattered_swept_);
  };
  if (whole_bins()) {
    set(lit ? 0 : 1);
    pass.sweep.launch({kSweepBins}, {1});
    return;
  }
  if (!lit) set_dark_boundary(pass);
  const std::size_t n = options_.grid;
  for (int plane = 0; plane < options_.grid; ++plane) {
    set(plane);
    pass.sweep.launch({n, n, kSweepBins}, {std::min(n, kRowGroup), 1, 1});
  }
}

/// Zeroes the boundary condition, which sweep_plane always reads.
void Sweeper::set_dark_boundary(const Pass& pass) {
  const std::size_t planes = 3 * directions_of(pass.parts) * plane_numbers(options_.grid);
  session_.fill_zero(border_, 2 * planes * number_bytes(options_.format.storage));
  session_.fill_zero(plane_buffer_, 2 * planes * sizeof(float));
}

/// Sweeps a cascade with its boundary condition into sums_, and stores the halo of the next finer one.
void Sweeper::sweep_cascade(Passes& passes, std::size_t cascade, const std::vector<ClpvGrid>& grids) {
  const bool lit = set_boundary(passes, cascade, grids);
  Pass& pass = passes[cascade];
  const ClpvSweepHalo stored = halo(cascade, grids);
  // Cells of the halo outside this grid are dark.
  if (!within(stored, options_.grid)) session_.fill_zero(pass.halo_light, pass.halo_light.bytes());
  launch(pass, cascade, sums_, stored, lit);
}

/// Sets bounced_ to `injected` and reflected light, for bounces beyond the first.
void Sweeper::add_bounces(std::size_t cascade, const std::vector<ClpvGrid>& grids, const Volume& injected) {
  if (scatters()) {
    add_bounces_in_medium(cascade, grids, injected);
  } else if (options_.bounces == Bounces::two) {
    set_sources(injected);
    sweep_cascade(bounce_passes_, cascade, grids);
    bouncer_->inject_reflected(cascade, sums_, 1, injected, *bounced_);
  } else if (cascade + 1 == options_.parts.size()) {
    add_series(grids[cascade].cell, injected);
  } else {
    bouncer_->inject_interpolated(cascade, offset_in_coarser(grids[cascade + 1], grids[cascade]), injected,
                                  *bounced_);
  }
}

/// Adds all bounces in the coarsest cascade, I + R D_1 + R (1 + E) D_2: two sweeps, and the series of
/// set_reflectors().
void Sweeper::add_series(float cell, const Volume& injected) {
  Pass& pass = bounce_passes_.back();
  const std::size_t coarsest = options_.parts.size() - 1;
  const bool lit = set_boundary(pass, cell);
  set_sources(injected);
  launch(pass, coarsest, first_swept_, {}, lit);
  bouncer_->inject_reflected(coarsest, first_swept_, 0, injected, *bounced_);
  set_sources(*bounced_);
  launch(pass, coarsest, sums_, {}, false);
  bouncer_->inject_series(first_swept_, sums_, injected, *bounced_);
}

/// The same where light is also scattered by a medium, whose source function then includes swept light: repeats sweep,
/// scattering and reflection.
void Sweeper::add_bounces_in_medium(std::size_t cascade, const std::vector<ClpvGrid>& grids,
                                    const Volume& injected) {
  const int sweeps = options_.bounces == Bounces::all ? kFurtherBounces + 2 : 1;
  for (int sweep = 0; sweep < sweeps; ++sweep) {
    set_sources(sweep == 0 ? injected : *bounced_);
    sweep_cascade(bounce_passes_, cascade, grids);
    medium_->scatter_swept(sums_);
    scattered_swept_ = true;
    bouncer_->inject_reflected(cascade, sums_, 1, injected, *bounced_);
  }
}

/// Projects swept light on harmonics; with all bounces also stores the incident flux that the next finer cascade
/// reflects.
void Sweeper::collect(std::size_t cascade, Volume& accumulated) {
  const Buffer* incident = bouncer_ && collect_with_incident_ ? bouncer_->incident(cascade) : nullptr;
  if (incident != nullptr) {
    collect_with_incident_->set(sums_, accumulated.memory(), *incident);
    return volumes_.launch(*collect_with_incident_, 3);
  }
  collect_.set(sums_, accumulated.memory());
  volumes_.launch(collect_, 3);
}

void Sweeper::sweep(std::size_t cascade, const std::vector<ClpvGrid>& grids, const Volume& injected,
                    Volume& accumulated) {
  if (bouncer_) add_bounces(cascade, grids, injected);
  set_sources(bouncer_ ? *bounced_ : injected);
  sweep_cascade(passes_, cascade, grids);
  collect(cascade, accumulated);
}

}  // namespace clpv
