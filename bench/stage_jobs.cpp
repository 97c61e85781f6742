// SPDX-License-Identifier: MIT
// Rows and jobs of the pipeline's stages, on the inputs of a scene.
#include "bench/stage_jobs.hpp"

#include <fmt/format.h>

#include "basis/basis.hpp"
#include "basis/sweep.hpp"
#include "verify/gather.hpp"
#include "verify/propagate.hpp"
#include "verify/sweep.hpp"

namespace clpv::bench {

Row make_row(const std::string& suite, std::string_view stage, const Variant& variant,
             const std::string& suffix) {
  const RenderOptions &o = variant.options, usual = timed_options();
  Row row;
  row.suite = suite;
  row.stage = stage;
  row.variant = variant;
  row.n = make_basis(o)->size();
  row.name = fmt::format("{}/{}/{}", stage, o.basis, format_name(o.format()));
  if (o.state != usual.state) row.name += fmt::format("/{}", name_of(o.state));
  if (lobes_of(o) != lobes_of(usual)) row.name += fmt::format("/{}", lobes_of(o));
  if (o.transport != usual.transport && stage != name_of(Stage::sweep))
    row.name += fmt::format("/{}", name_of(o.transport));
  if (o.blocked()) row.name += "/occlusion";
  if (variant.cascade) row.name += fmt::format("/cascade:{}", *variant.cascade);
  if (!variant.filtered) row.name += "/texels";
  row.name += suffix;
  return row;
}

Variant with_sweep(Variant variant) {
  RenderOptions& o = variant.options;
  o.transport = TransportKind::sweep;
  if (o.blocked()) o.blockers = Blockers::scene;
  o.blocking = Blocking::areas;
  return variant;
}

Case stage_case(Bench& bench, const std::string& suite, const StageJob& job, const Variant& variant) {
  const Variant timed = job.stage == Stage::sweep ? with_sweep(variant) : variant;
  return {make_row(suite, job.name(), timed),
          [&bench, make = job.make, timed] { return make(bench, timed); }};
}

namespace {

Job make_inject_job(Bench& bench, const Variant& variant, bool light, bool geometry) {
  const RenderOptions& o = variant.options;
  const int cascade = variant.cascade.value_or(0);
  const Inputs::CascadeViews& views = bench.inputs().views(cascade);
  verify::InjectProblem problem{make_basis(o), inject_options(o, false), views.grid, {}, {}};
  if (light) problem.light = views.rsm;
  if (geometry) problem.blockers = {views.rsm, views.camera};
  const std::string key = fmt::format("inject {} {} {} {} {} {} {}", o.basis, o.lambda, lobes_of(o), light,
                                      geometry, o.grid, cascade);
  return {verify::inject_job(bench.session, problem, bench.share(key))};
}

}  // namespace

Job inject_job(Bench& bench, const Variant& variant) {
  return make_inject_job(bench, variant, true, variant.options.blocked());
}

Job inject_light_job(Bench& bench, const Variant& variant) {
  return make_inject_job(bench, variant, true, false);
}

Job inject_geometry_job(Bench& bench, const Variant& variant) {
  return make_inject_job(bench, variant, false, true);
}

Job propagate_job(Bench& bench, const Variant& variant) {
  const RenderOptions& o = variant.options;
  const int cascade = variant.cascade.value_or(0);
  const std::shared_ptr<const Basis> basis = make_basis(o);
  verify::PropagateProblem problem{
      basis,        make_transport(o, *basis),             propagate_options(o),
      o.iterations, bench.inputs().light(*basis, cascade), {}};
  if (o.blocked()) problem.geometry = bench.inputs().geometry(*basis, cascade);
  const std::string key =
      fmt::format("propagate {} {} {} {} {} {} {} {}", o.basis, o.lambda, name_of(o.transport), lobes_of(o),
                  o.blocked(), o.grid, o.iterations, cascade);
  return {verify::propagate_job(bench.session, problem, bench.share(key))};
}

Job sweep_job(Bench& bench, const Variant& variant) {
  const RenderOptions& o = variant.options;
  const int cascade = variant.cascade.value_or(0);
  const std::shared_ptr<const Basis> basis = make_basis(o);
  verify::SweepProblem problem{basis,
                               make_transport(o, *basis),
                               sweep_options(o),
                               {bench.inputs().grids().at(cascade)},
                               {bench.inputs().light(*basis, cascade)},
                               {},
                               {}};
  problem.options.parts = {problem.options.parts.at(cascade)};
  if (o.blocked()) problem.blockers = {bench.inputs().areas(cascade)};
  const std::string key = fmt::format("sweep {} {} {} {} {} {}", o.basis, name_of(o.directions),
                                      name_of(o.blocking), o.blocked(), o.grid, cascade);
  return {verify::sweep_job(bench.session, problem, bench.share(key))};
}

Job gather_job(Bench& bench, const Variant& variant) {
  const RenderOptions& o = variant.options;
  const std::shared_ptr<const Basis> basis = make_basis(o);
  verify::GatherProblem problem{basis, o.transport, gather_options(o), {bench.inputs().grids(), {}, {}}};
  problem.options.filtered = variant.filtered;
  for (int c = 0; c < static_cast<int>(problem.cascades.grids.size()); ++c)
    problem.cascades.light.push_back(bench.inputs().light(*basis, c));
  const verify::InjectedSurface& camera = bench.inputs().views(0).camera;
  problem.camera = camera.surface, problem.image = camera.image;
  problem.every = kCheckedPixels;
  const std::string key = fmt::format("gather {} {} {} {} {} {}", o.basis, o.lambda, name_of(o.transport),
                                      lobes_of(o), name_of(o.evaluate), o.grid);
  return {verify::gather_job(bench.session, problem, bench.share(key))};
}

}  // namespace clpv::bench
