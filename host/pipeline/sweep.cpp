// SPDX-License-Identifier: MIT
#include "pipeline/sweep.hpp"

#include <algorithm>
#include <array>
#include <utility>

#include "basis/bounce.hpp"
#include "basis/sky_light.hpp"
#include "basis/sweep.hpp"
#include "codegen/sweep_source.hpp"
#include "pipeline/cascade.hpp"
#include "pipeline/sweep_tables.hpp"
#include "support/error.hpp"

namespace clpv {
namespace {

constexpr int kFirstParts = 1;  // of the bins that light takes to where it bounces

std::size_t directions_of(int parts) {
  return kSweepBins * parts * parts;
}

/// Of a plane by itself.
std::size_t plane_numbers(int grid) {
  return CLPV_SWEEP_LIVE_OF(std::size_t(grid));
}

/// The coarser cells that a finer cascade's border is made of, `offset` finer cells from the coarser grid's least corner.
ClpvSweepHalo halo_of(int grid, const std::array<int, 3>& offset) {
  const auto lower = [](int u) { return (u - 1) >> 1; };  // of the two coarser cells round a finer one
  ClpvSweepHalo halo{};
  halo.side = CLPV_SWEEP_HALO_SIDE_OF(grid);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    halo.first[axis] = lower(offset[axis] - 1);
    halo.layers[2 * axis] = lower(offset[axis] - 1);
    halo.layers[2 * axis + 1] = lower(offset[axis] + grid);
  }
  return halo;
}

/// Of what a cascade keeps for the next finer one.
std::size_t halo_bytes(const SweepOptions& options, int parts, std::size_t cascade) {
  if (cascade == 0) return sizeof(float);
  const std::size_t side = CLPV_SWEEP_HALO_SIDE_OF(options.grid);
  return 3 * 3 * directions_of(parts) * CLPV_SWEEP_HALO_FACE_OF(side) * number_bytes(options.format.storage);
}

bool within(const ClpvSweepHalo& halo, int grid) {
  return std::all_of(halo.first, halo.first + 3,
                     [&](int first) { return first >= 0 && first + halo.side <= grid; });
}

ProgramSource sweep_program(const SweepOptions& options, int parts, bool whole_bins) {
  ProgramSource source{"sweep.cl", {}, {}};
  source.literals.integer("CLPV_GRID", options.grid)
      .integer("CLPV_PARTS", parts * parts)
      .flag("CLPV_BLOCKING", options.blocking)
      .flag("CLPV_WHOLE_BINS", whole_bins);
  add_format_literals(source.literals, options.format, whole_bins ? 8 : 1);
  return source;
}

/// For the kernels that let light in at a border of bins in parts^2.
ProgramSource inflow_program(const char* file, const SweepOptions& options, int parts) {
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
      in_place_(options.bounces == Bounces::one && swept_in_place(basis, options.format)),
      source_(session, source_program(basis), "sweep_source"),
      collect_(session, volumes_.program("sweep_collect.cl", sweep_collect_text().text), "sweep_collect") {
  const std::size_t plane = plane_numbers(options.grid) * sizeof(float);
  const std::size_t swept = 3 * directions_of(*std::max_element(options.parts.begin(), options.parts.end()));
  const std::optional<VolumeFormat> swept_from = in_place_ ? std::optional(options.format) : std::nullopt;
  bins_ = session.upload(sweep_bin_table(options.grid, swept_from), "bins to sweep");
  light_ = volumes_.make(3 * kSweepBins, "light to sweep, and swept");
  live_ = zeroed_buffer(session, (whole_bins() ? 1 : 2) * swept * plane, "planes being swept");
  border_ =
      zeroed_buffer(session, 2 * swept * plane_numbers(options.grid) * number_bytes(options.format.storage),
                    "light at the border");
  if (options.blocking)
    links_.emplace(session, volumes_.program("sweep_links.cl", sweep_links_text(basis, transport)),
                   "sweep_links");
  const std::size_t links = options.blocking ? link_volumes().count() : 1;
  for (std::size_t c = 0; c < options.parts.size(); ++c)
    through_.push_back(volumes_.make(links, "transmittance to sweep through"));
  passes_ = make_passes(options.parts);
  if (options.bounces == Bounces::one) return;
  bouncer_.emplace(session, options);
  const bool all = options.bounces == Bounces::all;
  first_passes_ = make_passes(std::vector<int>(all ? 1 : options.parts.size(), kFirstParts));
  first_light_ = volumes_.make(3 * kSweepBins, "light to bounce");
  if (!all) return;
  second_light_ = volumes_.make(3 * kSweepBins, "light to bounce on");
  ProgramSource collecting =
      volumes_.program("sweep_collect.cl", sweep_collect_text().text + arriving_source_text());
  collecting.literals.flag("CLPV_FOR_FINER", true);
  collect_for_finer_.emplace(session, collecting, "sweep_collect");
}

/// Where light is swept from in place, of the bins across x and y alone.
ProgramSource Sweeper::source_program(const Basis& basis) const {
  ProgramSource source = volumes_.program("sweep_source.cl", sweep_source_text(basis).text);
  source.literals.flag("CLPV_Z_IN_PLACE", in_place_);
  return source;
}

bool Sweeper::whole_bins() const {
  return options_.form == SweepForm::bins ||
         (options_.form == SweepForm::suited && session_.device().type == "cpu");
}

Sweeper::Passes Sweeper::make_passes(const std::vector<int>& parts) {
  Passes passes;
  for (std::size_t c = 0; c < parts.size(); ++c) {
    const int coarser = c + 1 < parts.size() ? parts[c + 1] : 0;
    Pass pass{parts[c],
              session_.upload(sweep_direction_table(parts[c], coarser), "directions to sweep"),
              Kernel(session_, sweep_program(options_, parts[c], whole_bins()),
                     whole_bins() ? "sweep_bin" : "sweep_plane"),
              {},
              zeroed_buffer(session_, halo_bytes(options_, parts[c], c), "light for a finer cascade"),
              {},
              {}};
    if (coarser > 0) {
      ProgramSource border = inflow_program("sweep_border.cl", options_, parts[c]);
      border.literals.integer("CLPV_COARSER_PARTS", coarser * coarser);
      pass.let_in.emplace(session_, border, "sweep_border");
    }
    passes.push_back(std::move(pass));
  }
  return passes;
}

void Sweeper::block(std::size_t cascade, const Volume& geometry) {
  links_.value().set(geometry.memory(), through_[cascade]);
  volumes_.launch(*links_, 1);
}

void Sweeper::reflect(std::size_t cascade, const Volume& reflectors) {
  bouncer_.value().reflect(cascade, reflectors);
  if (options_.bounces != Bounces::all || cascade + 1 < options_.parts.size()) return;
  for (int bounce = 0; bounce < kFurtherBounces; ++bounce) {
    session_.fill_zero(first_light_, first_light_.bytes());
    bouncer_->send_on(first_light_);
    sweep(first_passes_.back(), cascade, {first_light_.handle(), first_light_, first_light_}, {}, false);
    bouncer_->meet_again(first_light_);
  }
}

void Sweeper::let_in(const Sky& sky) {
  for (Passes* passes : {&passes_, &first_passes_}) {
    if (passes->empty()) continue;
    Pass& coarsest = passes->back();
    coarsest.sky = session_.upload(swept_sky(sky, coarsest.parts), "light of the sky");
    coarsest.let_sky_in.emplace(session_, inflow_program("sweep_sky.cl", options_, coarsest.parts),
                                "sweep_sky");
  }
}

/// Where planes of odd number begin: the one before the first is of them.
cl_int Sweeper::before_first(const Pass& pass) const {
  return whole_bins() ? 0 : 3 * directions_of(pass.parts) * plane_numbers(options_.grid);
}

void Sweeper::launch_at_border(Kernel& kernel, const Pass& pass) {
  const std::size_t rows = options_.grid + 2;
  kernel.launch({(rows + 7) / 8, rows, 9 * directions_of(pass.parts)}, {1, std::min(rows, kRowGroup), 1});
}

/// Into the coarsest cascade; whether there is a sky.
bool Sweeper::let_sky_in(Pass& pass, float cell) {
  if (!pass.let_sky_in) return false;
  pass.let_sky_in->set(pass.sky, sky_scale_ * (cell * cell), live_, before_first(pass), border_);
  launch_at_border(*pass.let_sky_in, pass);
  return true;
}

bool Sweeper::let_in(Passes& passes, std::size_t cascade, const std::vector<ClpvGrid>& grids) {
  Pass& pass = passes[cascade];
  if (!pass.let_in) return let_sky_in(pass, grids[cascade].cell);
  const std::array<int, 3> offset = offset_in_coarser(grids[cascade + 1], grids[cascade]);
  pass.let_in->set(bins_, pass.directions, passes[cascade + 1].halo, halo_of(options_.grid, offset),
                   offset[0], offset[1], offset[2], live_, before_first(pass), border_);
  launch_at_border(*pass.let_in, pass);
  return true;
}

ClpvSweepHalo Sweeper::halo(std::size_t cascade, const std::vector<ClpvGrid>& grids) const {
  if (cascade == 0) return {};
  return halo_of(options_.grid, offset_in_coarser(grids[cascade], grids[cascade - 1]));
}

/// `lit`: light has been let in at the border.
void Sweeper::sweep(Pass& pass, std::size_t cascade, const Light& light, const ClpvSweepHalo& halo,
                    bool lit) {
  const auto set = [&](cl_int last) {
    pass.sweep.set(bins_, pass.directions, light.injected, light.sources, through_[cascade], border_, halo,
                   live_, light.sums, pass.halo, last);
  };
  if (whole_bins()) {
    set(lit ? 0 : 1);
    pass.sweep.launch({kSweepBins}, {1});
    return;
  }
  if (!lit) let_nothing_in(pass);
  const std::size_t n = options_.grid;
  for (int plane = 0; plane < options_.grid; ++plane) {
    set(plane);
    pass.sweep.launch({n, n, kSweepBins}, {std::min(n, kRowGroup), 1, 1});
  }
}

/// Where planes are swept one by one: a work-item finds what comes in beside its cell.
void Sweeper::let_nothing_in(const Pass& pass) {
  const std::size_t planes = 3 * directions_of(pass.parts) * plane_numbers(options_.grid);
  session_.fill_zero(border_, 2 * planes * number_bytes(options_.format.storage));
  session_.fill_zero(live_, 2 * planes * sizeof(float));
}

void Sweeper::sweep(Passes& passes, std::size_t cascade, const Light& light,
                    const std::vector<ClpvGrid>& grids) {
  const bool lit = let_in(passes, cascade, grids);
  Pass& pass = passes[cascade];
  const ClpvSweepHalo kept = halo(cascade, grids);
  // What lies beyond this grid is dark.
  if (!within(kept, options_.grid)) session_.fill_zero(pass.halo, pass.halo.bytes());
  sweep(pass, cascade, light, kept, lit);
}

/// Adds to light_ what surfaces send back.
void Sweeper::bounce(std::size_t cascade, const std::vector<ClpvGrid>& grids) {
  if (options_.bounces == Bounces::two) {
    sweep(first_passes_, cascade, {light_.handle(), light_, first_light_}, grids);
    bouncer_->bounce(cascade, first_light_, light_);
  } else if (cascade + 1 == options_.parts.size()) {
    bounce_in_all(grids[cascade].cell);
  } else {
    bouncer_->bounce_finer(cascade, offset_in_coarser(grids[cascade + 1], grids[cascade]), light_);
  }
}

/// In the coarsest cascade: twice in earnest, and from where the second one leaves light goes on as reflect() found.
void Sweeper::bounce_in_all(float cell) {
  Pass& pass = first_passes_.back();
  const std::size_t coarsest = options_.parts.size() - 1;
  const bool lit = let_sky_in(pass, cell);
  sweep(pass, coarsest, {light_.handle(), light_, first_light_}, {}, lit);
  session_.fill_zero(second_light_, second_light_.bytes());
  bouncer_->bounce(coarsest, first_light_, second_light_);
  sweep(pass, coarsest, {second_light_.handle(), second_light_, second_light_}, {}, false);
  bouncer_->bounce_on(first_light_, second_light_, light_);
}

/// Leaves harmonics, and of all bounces what falls on surfaces, for the next finer cascade.
void Sweeper::collect(std::size_t cascade, Volume& accumulated) {
  const Buffer* arriving = bouncer_ && collect_for_finer_ ? bouncer_->arriving(cascade) : nullptr;
  if (arriving != nullptr) {
    collect_for_finer_->set(light_, accumulated.memory(), *arriving);
    return volumes_.launch(*collect_for_finer_, 3);
  }
  collect_.set(light_, accumulated.memory());
  volumes_.launch(collect_, 3);
}

void Sweeper::sweep(std::size_t cascade, const std::vector<ClpvGrid>& grids, const Volume& injected,
                    Volume& accumulated) {
  source_.set(injected.memory(), light_);
  volumes_.launch(source_, 3);
  if (bouncer_) bounce(cascade, grids);
  sweep(passes_, cascade, {in_place_ ? injected.memory() : light_.handle(), light_, light_}, grids);
  collect(cascade, accumulated);
}

}  // namespace clpv
