// SPDX-License-Identifier: MIT
#include "pipeline/sweep/sweep.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>

#include "basis/bounce.hpp"
#include "basis/sky_light.hpp"
#include "basis/sweep.hpp"
#include "pipeline/sweep/sweep_literals.hpp"

namespace clpv {
namespace {

constexpr float kCellRatio = 2;  // ratio of a coarser cascade's cell to the next finer one's

std::size_t directions_of(int parts) {
  return kSweepBins * parts * parts;
}

/// Coarser cells that the border of a finer cascade interpolates. `offset`: offset_in_coarser().
ClpvSweepHalo halo_of(int grid, const std::array<int, 3>& offset) {
  const auto lower = [](int u) {
    return (u - 1) >> 1;
  };  // lower_cell() of kernels/sweep/sweep_border.cl
  ClpvSweepHalo halo{};
  halo.side = halo_side(grid);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    halo.first[axis] = lower(offset[axis] - 1);
    halo.layers[2 * axis] = lower(offset[axis] - 1);
    halo.layers[2 * axis + 1] = lower(offset[axis] + grid);
  }
  return halo;
}

/// Bytes of the halo light that a cascade stores for the next finer one.
std::size_t halo_bytes(const SweepOptions& options, int parts) {
  return 3 * 3 * directions_of(parts) * halo_face_size(halo_side(options.grid)) *
         number_bytes(options.format.storage);
}

bool within(const ClpvSweepHalo& halo, int grid) {
  return std::all_of(halo.first, halo.first + 3,
                     [&](int first) { return first >= 0 && first + halo.side <= grid; });
}

/// Kernels that set the boundary condition of a cascade whose bins have parts^2 parts.
ProgramSource border_program(const char* file, const SweepOptions& options, int parts, int lanes) {
  ProgramSource source{file};
  source.literals.integer("CLPV_PARTS", parts * parts);
  add_volume_literals(source.literals, options.grid, options.format, lanes);
  return source;
}

}  // namespace

Sweeper::Sweeper(Session& session, const Basis& basis, const Transport& transport,
                 const SweepOptions& options)
    : session_(session),
      options_(options),
      volumes_(session, options.grid, options.format),
      source_(session, volumes_.program("sweep/sweep_source.cl", source_literals(basis)),
              "sweep_source"),
      collect_(
          session,
          volumes_.program("sweep/sweep_collect.cl", sweep_collect_literals(options.most_white)),
          "sweep_collect"),
      join_furnace_(
          session,
          volumes_.program("sweep/sweep_collect.cl", sweep_collect_literals(options.most_white)),
          "join_furnace"),
      bouncer_(session, basis, options,
               options.bounces == Bounces::all && !scatters(options.medium)) {
  const std::size_t plane = bordered_plane_size(options.grid) * sizeof(float);
  const std::size_t ordinates =
      3 * directions_of(*std::max_element(options.parts.begin(), options.parts.end()));
  bins_ = session.upload(sweep_bin_table(options.grid), "bins to sweep");
  sources_.coefficients = volumes_.make(2 * 3 * basis.size(), "sources of the sweep");
  sources_.lit = zeroed_buffer(session, 2 * sweep_volume_size(options.grid) / volumes_.lanes(),
                               "lit rows of the sweep");
  swept_ = volumes_.make(3 * kSweepBins, "sums of the sweep");
  plane_buffer_ = zeroed_buffer(session, (form() == SweepForm::planes ? 2 : 1) * ordinates * plane,
                                "plane buffer of the sweep");
  border_ = zeroed_buffer(
      session,
      2 * ordinates * bordered_plane_size(options.grid) * number_bytes(options.format.storage),
      "boundary condition of the sweep");
  if (options.points) {
    count_hidden_points_.emplace(session, volumes_.program("sweep/seen_points.cl"),
                                 "count_hidden_points");
    hidden_ = zeroed_buffer(
        session, CLPV_HIDDEN_WORDS * bordered_volume_size(options.grid) * sizeof(cl_uint),
        "hidden points of the sweep's links");
  }
  if (blocks()) {
    Literals literals = sweep_links_literals(basis, transport);
    literals.flag("CLPV_POTENTIAL", options.blocking).flag("CLPV_POINTS", options.points);
    transmittance_.emplace(session, volumes_.program("sweep/sweep_links.cl", std::move(literals)),
                           "sweep_links");
  }
  if (options.medium)
    medium_.emplace(session, volumes_, *options.medium, options.grid, options.parts.size());
  plan_ = sweep_plan(options_.bounces, scatters(options_.medium), options_.bounce_sweeps);
  for (std::size_t c = 0; c < options_.parts.size(); ++c)
    cascades_.push_back(make_directions(basis, c));
  if (plan_.back().light == SweptLight::series)
    last_swept_ = volumes_.make(3 * kSweepBins, "light of the first bounce");
}

/// Light that enters at a cascade's border. True: in every sweep, the coarser cascade's final
/// light; false: the coarser cascade's light after the same number of bounces.
bool Sweeper::last_light_enters() const {
  return options_.bounces == Bounces::all && !scatters(options_.medium);
}

/// The coarser cascade's halo that enters at the border in a sweep that stores `halo`.
Sweeper::Halo Sweeper::entering(Halo halo) const {
  if (!last_light_enters()) return halo;
  return halo < kWhite ? kLast : kWhite;
}

/// Returns true if sweeps of a cascade store this halo for the next finer one.
bool Sweeper::feeds_finer(Halo halo, std::size_t cascade) const {
  return cascade > 0 && entering(halo) == halo && (halo % 2 == kLast || plan_.size() > 1);
}

/// Program of sweep_bins.cl or sweep_planes.cl, for light of `coefficients`.
ProgramSource Sweeper::sweep_program(int coefficients, const SweepMeans& means, int parts) const {
  ProgramSource source{fmt::format("sweep/sweep_{}.cl", name_of(form()))};
  source.literals.integer("CLPV_PARTS", parts * parts)
      .integer("CLPV_SOURCES", coefficients)
      .integer("CLPV_EMITTING", means.emitting)
      .integer("CLPV_SOURCE_LANES", volumes_.lanes())
      .flag("CLPV_BLOCKING", blocks())
      .flag("CLPV_MEDIUM", options_.medium.has_value());
  add_volume_literals(source.literals, options_.grid, options_.format,
                      form() == SweepForm::bins ? 8 : 1);
  if (form() == SweepForm::groups) source.literals.number("CLPV_ITEMS", group());
  source.literals.flag("CLPV_COSINE_REST", means.rest.has_value());
  if (means.rest) {
    for (std::size_t i = 0; i < means.rest->even.size(); ++i)
      source.literals.real(fmt::format("CLPV_COSINE_E{}", 2 * i), means.rest->even[i]);
  }
  return source;
}

/// Groups need local memory for a plane of all parts of a bin, and know no media.
SweepForm Sweeper::form() const {
  if (options_.form != SweepForm::suited) return options_.form;
  if (session_.device().lanes == 8) return SweepForm::bins;
  const std::size_t side = options_.grid + 2,
                    parts = *std::max_element(options_.parts.begin(), options_.parts.end());
  const auto local = session_.device().handle.getInfo<CL_DEVICE_LOCAL_MEM_SIZE>();
  const bool fits = parts * parts * side * side * sizeof(float) <= local;
  return fits && group() > 0 && !options_.medium ? SweepForm::groups : SweepForm::planes;
}

/// Work-items that sweep a channel of a bin: each takes one cell of a plane, or a few; 0 on devices
/// with smaller groups than other kernels need.
std::size_t Sweeper::group() const {
  constexpr std::size_t kLeast = 64, kMost = 512;
  const std::size_t cells = std::size_t(options_.grid) * options_.grid,
                    most = session_.device().handle.getInfo<CL_DEVICE_MAX_WORK_GROUP_SIZE>();
  return std::min(std::min(most, kMost) / kLeast * kLeast, (cells + kLeast - 1) / kLeast * kLeast);
}

Sweeper::Directions Sweeper::make_directions(const Basis& basis, std::size_t cascade) const {
  const int parts = options_.parts[cascade];
  const int coarser = cascade + 1 == options_.parts.size() ? 0 : options_.parts[cascade + 1];
  const SweepMeans means = sweep_means(basis, parts);
  std::vector<ClpvSweepDirection> table = sweep_direction_table(parts, coarser);
  const Buffer light_table = session_.upload(table, "directions to sweep");
  for (ClpvSweepDirection& each : table) each.from_coarser *= kCellRatio * kCellRatio;
  Directions made{
      parts,
      coarser,
      light_table,
      session_.upload(table, "directions of the furnace"),
      session_.upload(means.coefficients, "coefficients of the sweep's bins"),
      session_.upload(means.means, "means of the basis's functions"),
      volumes_.make(blocks() ? link_volumes().count() : 1, "transmittance of the sweep's links"),
      Kernel(session_, sweep_program(basis.size(), means, parts),
             form() == SweepForm::bins     ? "sweep_bin"
             : form() == SweepForm::groups ? "sweep_group"
                                           : "sweep_plane")};
  for (const Halo halo : {kLast, kEarlier, kWhite, kWhiteEarlier})
    made.halos[halo] = zeroed_buffer(
        session_, feeds_finer(halo, cascade) ? halo_bytes(options_, parts) : sizeof(float),
        "boundary light of a finer cascade");
  if (coarser > 0) {
    ProgramSource border =
        border_program("sweep/sweep_border.cl", options_, parts, session_.device().lanes);
    border.literals.integer("CLPV_COARSER_PARTS", coarser * coarser);
    made.border.emplace(session_, border, "sweep_border");
    const std::size_t words = 3 * kSweepBins * bordered_plane_size(options_.grid);
    for (Buffer* each : {&made.hidden, &made.closed})
      *each = zeroed_buffer(session_, words * sizeof(cl_uint), "what a cascade's border sees");
    if (options_.points) made.count_hidden.emplace(session_, border, "count_hidden_at_border");
  } else {
    Sky even;
    even.width = even.height = 1, even.texels = {glm::vec3(0, 1, 1)};
    made.white_sky = session_.upload(swept_sky(even, parts), "boundary light of the furnace");
    if (options_.sky != nullptr)
      made.sky = session_.upload(swept_sky(*options_.sky, parts), "boundary light of the sky");
    made.sky_border.emplace(
        session_, border_program("sweep/sweep_sky.cl", options_, parts, session_.device().lanes),
        "sweep_sky");
  }
  return made;
}

/// Sets where a cascade lies in the medium, and how its directions are attenuated.
void Sweeper::enter_medium(std::size_t cascade, const ClpvGrid& grid) {
  if (!medium_) return;
  const auto attenuate_along = [&](const Directions& directions) {
    std::vector<ClpvSweepDirection> table =
        sweep_direction_table(directions.parts, directions.coarser);
    attenuate(table, directions.parts, *options_.medium, double{grid.cell});
    session_.write(directions.table, table);
  };
  attenuate_along(cascades_[cascade]);
  medium_->place(cascade, grid);
}

void Sweeper::set_blockers(std::size_t cascade, const std::vector<ClpvGrid>& grids,
                           const Volume* geometry, const Buffer& occluded) {
  Directions& directions = cascades_[cascade];
  transmittance_.value().set(directions.links);
  if (options_.blocking) transmittance_->add(geometry->memory());
  if (options_.points) {
    const std::size_t n = options_.grid;
    if (directions.border) {
      const std::array<int, 3> offset = offset_in_coarser(grids[cascade + 1], grids[cascade]);
      directions.count_hidden.value().set(bins_, offset[0], offset[1], offset[2], occluded,
                                          static_cast<cl_uint>(cascade + 1), directions.hidden,
                                          directions.closed);
      directions.count_hidden->launch({n + 2, n + 2, 3 * kSweepBins},
                                      {std::min(n + 2, kRowGroup), 1, 1});
    }
    count_hidden_points_.value().set(occluded, static_cast<cl_uint>(cascade), hidden_);
    count_hidden_points_->launch({n + 1, n + 1, n + 1}, {std::min(n + 1, kRowGroup), 1, 1});
    transmittance_->add(hidden_);
  }
  volumes_.launch(*transmittance_, 1);
}

void Sweeper::set_surfaces(std::size_t cascade, const std::vector<ClpvGrid>& grids,
                           const Volume& white, const Volume* reflectors, Volume& accumulated) {
  const auto sweep_faces = [&](const Volume& faces, Halo halo) {
    bouncer_.inject_white(faces, sources_);
    sweep_white(halo, cascade, grids);
  };
  // Backs reflect, too: in their own furnace no light grows from bounce to bounce.
  const Volume* normalised = nullptr;
  if (reflectors != nullptr) {
    sweep_faces(*reflectors, kWhiteEarlier);
    normalised = &bouncer_.set_reflectors(cascade, swept_, *reflectors);
  }
  sweep_faces(white, kWhite);
  collect(accumulated, 3, 1);
  if (plan_.back().light != SweptLight::series) return;
  enter_medium(cascade, grids[cascade]);
  const auto sweep_reflected = [&](const Volume& flux) {
    bouncer_.inject_flux(flux, *normalised, sources_);
    launch(kEarlier, cascade, {}, false);
  };
  sweep_reflected(*normalised);
  sweep_reflected(bouncer_.reflect_returned(cascade, swept_));
  bouncer_.sum_series(cascade, swept_);
}

/// Sweeps the sources as those of the white furnace: in open space, with radiance 1 at the border.
void Sweeper::sweep_white(Halo halo, std::size_t cascade, const std::vector<ClpvGrid>& grids) {
  light_border(halo, cascade, grids, cascades_[cascade].white_sky, 1, 1);
  launch(halo, cascade, prepare_halo(halo, cascade, grids), true);
  join_furnace_.set(swept_);
  join_furnace_.launch({kSweepBins * sweep_volume_size(options_.grid) / volumes_.lanes()}, {1});
}

void Sweeper::sweep(const SweepInput& input, Volume& accumulated) {
  enter_medium(input.cascade, input.grids[input.cascade]);
  if (medium_) medium_->scatter_lights(input.grids[input.cascade], input.lights);
  bordered_.reset();
  for (const SweepStep& step : plan_) run(step, &step == &plan_.back() ? kLast : kEarlier, input);
  collect(accumulated, 0, 3);
}

/// Sweeps the light of a step with its boundary condition, and stores the halo of the next finer
/// cascade.
void Sweeper::run(const SweepStep& step, Halo halo, const SweepInput& input) {
  if (step.scattered) medium_->scatter_swept(swept_);
  set_sources(step, input);
  const float cell = input.grids[input.cascade].cell;
  // The boundary condition serves all sweeps that take the same light. Groups leave it as it is,
  // others only its rows and columns.
  const bool stands = bordered_ == entering(halo);
  const bool lit = (stands && form() == SweepForm::groups) ||
                   light_border(halo, input.cascade, input.grids, cascades_[input.cascade].sky,
                                input.sky_scale * (cell * cell), 0, stands);
  bordered_ = lit ? std::optional(entering(halo)) : std::nullopt;
  const ClpvSweepHalo stored = prepare_halo(halo, input.cascade, input.grids);
  if (last_swept_.exists()) std::swap(swept_, last_swept_);
  launch(halo, input.cascade, stored, lit, step.scattered);
}

/// Returns the cells whose light a sweep stores for the next finer cascade.
ClpvSweepHalo Sweeper::prepare_halo(Halo kind, std::size_t cascade,
                                    const std::vector<ClpvGrid>& grids) {
  if (!feeds_finer(kind, cascade)) return {};
  const ClpvSweepHalo stored = halo(cascade, grids);
  // Cells of the halo outside this grid are dark.
  const Buffer& light = cascades_[cascade].halos[kind];
  if (!within(stored, options_.grid)) session_.fill_zero(light, light.bytes());
  return stored;
}

/// Sets the light that the next sweep injects.
void Sweeper::set_sources(const SweepStep& step, const SweepInput& input) {
  switch (step.light) {
    case SweptLight::injected:
      source_.set(input.injected.memory(), sources_.coefficients, sources_.lit);
      return volumes_.launch(source_, 1);
    case SweptLight::reflected:
    case SweptLight::relaxed:
      return bouncer_.inject_reflected(input.cascade, swept_, input.injected, sources_,
                                       step.light == SweptLight::relaxed);
    case SweptLight::series:
      return bouncer_.inject_series(input.cascade, last_swept_, swept_, input.injected, sources_);
  }
}

/// Sets the boundary condition of a cascade from the next coarser one, or from `sky` times
/// `sky_scale`. Returns false, and sets nothing, if no light enters. `rows_stand`: sets at least
/// the planes.
bool Sweeper::light_border(Halo halo, std::size_t c, const std::vector<ClpvGrid>& grids,
                           const Buffer& sky, float sky_scale, cl_int first_lit, bool rows_stand) {
  Directions& directions = cascades_[c];
  if (!directions.border && !sky.exists()) return false;
  Kernel& kernel = directions.border ? *directions.border : *directions.sky_border;
  // A sweep by planes reads the plane upstream of the grid among the odd ones.
  const cl_int upstream = form() == SweepForm::planes ? 3 * directions_of(directions.parts) *
                                                            bordered_plane_size(options_.grid)
                                                      : 0;
  std::size_t slices = 9 * directions_of(directions.parts);
  if (directions.border) {
    const cl_int face_step = rows_stand ? 3 : 1;
    slices = 3 * kSweepBins / face_step;
    const std::array<int, 3> offset = offset_in_coarser(grids[c + 1], grids[c]);
    kernel.set(bins_, halo < kWhite ? directions.table : directions.white_table,
               cascades_[c + 1].halos[entering(halo)], directions.hidden, directions.closed,
               halo_of(options_.grid, offset), offset[0], offset[1], offset[2], first_lit,
               face_step, plane_buffer_, upstream, border_);
  } else {
    kernel.set(sky, sky_scale, plane_buffer_, upstream, border_);
  }
  const std::size_t rows = options_.grid + 2, lanes = session_.device().lanes;
  kernel.launch({(rows + lanes - 1) / lanes, rows, slices}, {1, std::min(rows, kRowGroup), 1});
  return true;
}

ClpvSweepHalo Sweeper::halo(std::size_t cascade, const std::vector<ClpvGrid>& grids) const {
  if (cascade == 0) return {};
  return halo_of(options_.grid, offset_in_coarser(grids[cascade], grids[cascade - 1]));
}

/// Launches the sweep of a cascade into swept_. `lit`: light_border() has set light at the border.
void Sweeper::launch(Halo halo, std::size_t cascade, const ClpvSweepHalo& stored, bool lit,
                     bool scattered) {
  Directions& directions = cascades_[cascade];
  const auto set = [&](cl_int last) {
    directions.sweep.set(bins_, halo < kWhite ? directions.table : directions.white_table,
                         directions.coefficients, directions.means, sources_.coefficients,
                         sources_.lit, directions.links, border_, stored, plane_buffer_, swept_,
                         directions.halos[entering(halo)], last);
    if (medium_)
      medium_->add_to(directions.sweep, cascade, scattered);
    else
      directions.sweep.add(directions.table, sources_.coefficients);  // not read
  };
  const std::size_t n = options_.grid;
  if (form() != SweepForm::planes) {
    set(lit ? 0 : 1);
    const std::size_t items = form() == SweepForm::bins ? 1 : group();
    directions.sweep.launch({(form() == SweepForm::bins ? 1 : 3) * kSweepBins * items}, {items},
                            Chain{n});
    return;
  }
  if (!lit) darken_border(directions);
  for (int plane = 0; plane < options_.grid; ++plane) {
    set(plane);
    directions.sweep.launch({n, n, kSweepBins}, {std::min(n, kRowGroup), 1, 1}, Chain{1});
  }
}

/// Zeroes the boundary condition, which sweep_plane always reads.
void Sweeper::darken_border(const Directions& directions) {
  const std::size_t planes =
      3 * directions_of(directions.parts) * bordered_plane_size(options_.grid);
  session_.fill_zero(border_, 2 * planes * number_bytes(options_.format.storage));
  session_.fill_zero(plane_buffer_, 2 * planes * sizeof(float));
}

/// Projects the first channels of swept light on harmonics, and writes them from channel `first`
/// on.
void Sweeper::collect(Volume& accumulated, int first, int channels) {
  collect_.set(swept_, accumulated.memory(), cl_int{first});
  volumes_.launch(collect_, channels);
}

}  // namespace clpv
