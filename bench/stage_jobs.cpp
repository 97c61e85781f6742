// SPDX-License-Identifier: MIT
// Rows and jobs of the pipeline's stages, on the inputs of a scene.

#include "bench/stage_jobs.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "basis/basis.hpp"
#include "basis/sweep.hpp"
#include "pipeline/frame/cascade.hpp"
#include "pipeline/inject/inject.hpp"
#include "pipeline/raster/rasterize.hpp"
#include "pipeline/raster/scene_buffers.hpp"
#include "pipeline/raster/view.hpp"
#include "pipeline/voxels/voxel_field.hpp"
#include "reference/inject.hpp"
#include "support/error.hpp"
#include "verify/jobs.hpp"
#include "volume/volume.hpp"

namespace clpv::bench {

// Rasterises and injects the inputs of the benchmarked stages.

namespace {

constexpr double kMargin = 1e-4;  // [cells]: about 100 roundings of a position in a cascade

/// Returns true if rounding decides the cell of a point.
bool near_boundary(const glm::dvec3& point) {
  const glm::dvec3 off = glm::abs(point - glm::round(point));
  return std::min({off.x, off.y, off.z}) < kMargin;
}

/// Returns `image` without texels near a boundary of a light cell or a geometry cell.
SurfaceImage without_boundary_texels(SurfaceImage image, const ClpvGrid& grid, bool in_front) {
  for (std::size_t i = 0; i < image.depth.size(); ++i) {
    if (image.depth[i] <= 0) continue;
    const bool light = near_boundary(reference::light_point(image, i, grid, in_front));
    if (light || near_boundary(reference::grid_point(image, i, grid) + 0.5)) image.depth[i] = 0;
  }
  return image;
}

}  // namespace

Inputs::Inputs(Session& session, const SceneData& scene, const SceneCamera& camera,
               const RenderOptions& options)
    : session_(session), options_(options), scene_(upload_scene(session, scene)) {
  const std::vector<SceneLight> lights = scene.lights_for(camera);
  if (lights.empty()) throw Error(ExitCode::bad_input, "{}: no light; bench needs one", scene.name);
  Rasterizer rasterizer(session, scene_);
  Surface surface = make_surface(session, camera_view(camera, options.width, options.height),
                                 RsmFormat::float32, false);
  rasterizer.rasterize_camera(surface);
  const SurfaceImage image = read_surface(session, surface);
  const bool in_front = inject_options(options, false).in_front;
  for (const ClpvGrid& grid :
       cascade_grids(camera.eye, options.cascades, options.cascade_size, options.grid)) {
    Surface rsm = make_surface(
        session, rsm_views(lights.front().data, grid, scene_.bounds, options.rsm_size).front(),
        options.rsm_format, false);
    rasterizer.rasterize_rsm(lights.front().data, rsm);
    views_.push_back(
        {grid,
         verify::upload_injected(
             session, without_boundary_texels(read_surface(session, rsm), grid, in_front),
             options.rsm_format, rsm.colour_scale),
         verify::upload_injected(session, without_boundary_texels(image, grid, in_front),
                                 RsmFormat::float32)});
  }
}

std::vector<ClpvGrid> Inputs::grids() const {
  std::vector<ClpvGrid> grids;
  for (const CascadeViews& views : views_) grids.push_back(views.grid);
  return grids;
}

const Inputs::InjectedVolumes& Inputs::injected(const Basis& basis, int cascade) {
  const auto [entry, made] = injected_.try_emplace({basis.name(), cascade});
  if (made) {
    const int grid = options_.grid;
    Injector injector(session_, basis, InjectOptions{.grid = grid});
    Volume light(session_, {grid, basis.size(), 3}, "bench: injected light");
    Volume geometry(session_, {grid + 1, basis.size(), 1}, "bench: geometry volume");
    const CascadeViews& source = views(cascade);
    injector.inject_light(source.rsm.surface, source.grid, light);
    injector.inject_geometry(source.rsm.surface, source.grid, geometry);
    injector.inject_geometry(source.camera.surface, source.grid, geometry);
    entry->second = {to_host(light), to_host(geometry)};
  }
  return entry->second;
}

verify::SharedVolume Inputs::areas(int cascade) {
  const auto [entry, made] = areas_.try_emplace(cascade);
  if (made) {
    Volume geometry(session_, {options_.grid + 1, 3, 1}, "bench: geometry volume");
    VoxelField(session_, scene_, blocker_masks(scene_, options_.grid, 1, {}))
        .update(0, views(cascade).grid, geometry);
    entry->second = to_host(geometry);
  }
  return entry->second;
}

verify::SharedVolume Inputs::to_host(const Volume& volume) {
  const auto& [n, coefficients, channels] = volume.shape();
  const auto copy = std::make_shared<reference::Volume>(n, coefficients, channels);
  const std::vector<float> values = volume.read(session_);
  copy->values.assign(values.begin(), values.end());
  return copy;
}

Row make_row(const std::string& suite, std::string_view stage, const Problem& problem,
             const std::string& suffix) {
  const RenderOptions &o = problem.options, usual = timed_options();
  Row row;
  row.suite = suite;
  row.stage = stage;
  row.problem = problem;
  row.coefficients = make_basis(o)->size();
  row.name = fmt::format("{}/{}/{}", stage, o.basis, format_name(o.format()));
  if (lobes_of(o) != lobes_of(usual)) row.name += fmt::format("/{}", lobes_of(o));
  if (o.transport != usual.transport && stage != name_of(Stage::sweep))
    row.name += fmt::format("/{}", name_of(o.transport));
  if (o.blocked()) row.name += "/occlusion";
  if (problem.cascade) row.name += fmt::format("/cascade:{}", *problem.cascade);
  if (!problem.filtered) row.name += "/texels";
  row.name += suffix;
  return row;
}

Problem with_sweep(Problem problem) {
  RenderOptions& o = problem.options;
  o.transport = TransportKind::sweep;
  if (o.blocked()) o.blockers = Blockers::scene;
  o.blocking = Blocking::areas;
  return problem;
}

Case stage_case(const std::shared_ptr<Bench>& bench, const std::string& suite, const StageJob& job,
                const Problem& problem) {
  const Problem timed = job.stage == Stage::sweep ? with_sweep(problem) : problem;
  return {make_row(suite, job.name(), timed),
          [bench, make = job.make, timed] { return make(*bench, timed); }};
}

namespace {

Job make_inject_job(Bench& bench, const Problem& problem, bool light, bool geometry) {
  const RenderOptions& o = problem.options;
  const int cascade = problem.cascade.value_or(0);
  const Inputs::CascadeViews& views = bench.inputs().views(cascade);
  verify::InjectProblem input{make_basis(o), inject_options(o, false), views.grid, {}, {}};
  input.on_entries = true;
  if (light) input.light = views.rsm;
  if (geometry) input.blockers = {views.rsm, views.camera};
  const std::string key = fmt::format("inject {} {} {} {} {} {} {}", o.basis, o.lambda, lobes_of(o),
                                      light, geometry, o.grid, cascade);
  return {verify::inject_job(bench.session, input, bench.share(key))};
}

}  // namespace

Job inject_job(Bench& bench, const Problem& problem) {
  return make_inject_job(bench, problem, true, problem.options.blocked());
}

Job inject_light_job(Bench& bench, const Problem& problem) {
  return make_inject_job(bench, problem, true, false);
}

Job inject_geometry_job(Bench& bench, const Problem& problem) {
  return make_inject_job(bench, problem, false, true);
}

Job propagate_job(Bench& bench, const Problem& problem) {
  const RenderOptions& o = problem.options;
  const int cascade = problem.cascade.value_or(0);
  const std::shared_ptr<const Basis> basis = make_basis(o);
  verify::PropagateProblem input{basis,
                                 make_transport(o, *basis),
                                 propagate_options(o),
                                 o.iterations,
                                 bench.inputs().light(*basis, cascade),
                                 {}};
  if (o.blocked()) input.geometry = bench.inputs().geometry(*basis, cascade);
  const std::string key =
      fmt::format("propagate {} {} {} {} {} {} {} {}", o.basis, o.lambda, name_of(o.transport),
                  lobes_of(o), o.blocked(), o.grid, o.iterations, cascade);
  return {verify::propagate_job(bench.session, input, bench.share(key))};
}

Job sweep_job(Bench& bench, const Problem& problem) {
  const RenderOptions& o = problem.options;
  const int cascade = problem.cascade.value_or(0);
  const std::shared_ptr<const Basis> basis = make_basis(o);
  verify::SweepProblem input{basis,
                             make_transport(o, *basis),
                             sweep_options(o),
                             {bench.inputs().grids().at(cascade)},
                             {bench.inputs().light(*basis, cascade)},
                             {},
                             {}};
  input.options.parts = {input.options.parts.at(cascade)};
  if (o.blocked()) input.blockers = {bench.inputs().areas(cascade)};
  const std::string key = fmt::format("sweep {} {} {} {} {} {}", o.basis, name_of(o.directions),
                                      name_of(o.blocking), o.blocked(), o.grid, cascade);
  return {verify::sweep_job(bench.session, input, bench.share(key))};
}

Job gather_job(Bench& bench, const Problem& problem) {
  const RenderOptions& o = problem.options;
  const std::shared_ptr<const Basis> basis = make_basis(o);
  verify::GatherProblem input{
      basis, o.transport, gather_options(o), {bench.inputs().grids(), {}, {}}};
  input.options.filtered = problem.filtered;
  for (int c = 0; c < static_cast<int>(input.cascades.grids.size()); ++c)
    input.cascades.light.push_back(bench.inputs().light(*basis, c));
  const verify::InjectedSurface& camera = bench.inputs().views(0).camera;
  input.camera = camera.surface, input.image = camera.image;
  input.every = kCheckedPixels;
  const std::string key =
      fmt::format("gather {} {} {} {} {} {}", o.basis, o.lambda, name_of(o.transport), lobes_of(o),
                  name_of(o.evaluate), o.grid);
  return {verify::gather_job(bench.session, input, bench.share(key))};
}

}  // namespace clpv::bench
