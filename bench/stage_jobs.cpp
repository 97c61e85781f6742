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

Case stage_case(Bench& bench, const std::string& suite, const StageJob& job,
                const Problem& problem) {
  const Problem timed = job.stage == Stage::sweep ? with_sweep(problem) : problem;
  return {make_row(suite, job.name(), timed),
          [&bench, make = job.make, timed] { return make(bench, timed); }};
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
