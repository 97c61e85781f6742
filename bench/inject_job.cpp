// SPDX-License-Identifier: MIT
// Job of stage `inject`: RSM and G-buffer to light volume and geometry volume.
#include <fmt/format.h>

#include <cmath>
#include <span>

#include "basis/basis.hpp"
#include "bench/stage_jobs.hpp"
#include "pipeline/inject/inject.hpp"
#include "reference/inject.hpp"
#include "verify/comparison.hpp"
#include "verify/tolerances.hpp"

namespace clpv::bench {
namespace {

/// Volumes to inject: either, or both.
struct VolumeSelection {
  bool light, geometry;
};

struct Injection {
  std::unique_ptr<Basis> basis;
  std::unique_ptr<Volume> light, geometry;
  Injector injector;

  Injection(Session& session, const RenderOptions& o, const VolumeSelection& volumes)
      : basis(make_basis(o)), injector(session, *basis, inject_options(o, false)) {
    if (volumes.light)
      light = std::make_unique<Volume>(session, VolumeShape{o.grid, basis->size(), 3},
                                       "bench: injected light", o.format());
    if (volumes.geometry)
      geometry =
          std::make_unique<Volume>(session, VolumeShape{o.grid + 1, blocking_size(o.blocking, *basis), 1},
                                   "bench: geometry volume", o.format());
  }
};

/// Expected volumes: light (if injected), then geometry (if injected) and the alternative geometry that is equally correct
/// where rounding decides between two surfaces.
std::vector<double> expected_volumes(const Injection& injection, const Inputs::CascadeViews& views,
                                     const InjectOptions& options) {
  const Basis& basis = *injection.basis;
  const int grid = static_cast<int>(views.grid.n);
  std::vector<double> values;
  if (injection.light) {
    reference::Volume light(grid, basis.size(), 3);
    reference::inject_light(views.rsm_image, views.grid, basis, options, light);
    values = std::move(light.values);
  }
  if (!injection.geometry) return values;
  reference::Volume from_rsm(grid + 1, blocking_size(options.blocking, basis), 1), from_camera = from_rsm;
  reference::inject_geometry(views.rsm_image, views.grid, basis, options, from_rsm);
  reference::inject_geometry(views.camera_image, views.grid, basis, options, from_camera);
  const reference::Volume alternative =
      reference::merged_against_ties(from_rsm, from_camera, basis, options.blocking);
  reference::merge_geometry(from_camera, basis, options.blocking, from_rsm);
  values.insert(values.end(), from_rsm.values.begin(), from_rsm.values.end());
  values.insert(values.end(), alternative.values.begin(), alternative.values.end());
  return values;
}

void run(Injection& p, const Inputs::CascadeViews& views) {
  if (p.light) p.injector.inject_light(views.rsm, views.grid, *p.light);
  if (!p.geometry) return;
  p.injector.inject_geometry(views.rsm, views.grid, *p.geometry);
  p.injector.inject_geometry(views.camera, views.grid, *p.geometry);
}

Deviation verify(const Injection& p, Bench& bench, const Inputs::CascadeViews& views,
                 const Variant& variant) {
  const RenderOptions& o = variant.options;
  const std::string key =
      fmt::format("inject {} {} {} {} {} {} {}", o.basis, o.lambda, lobes_of(o), p.light != nullptr,
                  p.geometry != nullptr, o.grid, variant.cascade.value_or(0));
  const InjectOptions options = inject_options(o, false);
  const auto expected = bench.expected(key, [&] { return expected_volumes(p, views, options); });
  const bool usual_tolerance = o.lobe == LobeKind::exact || o.storage == Storage::float16;
  Deviation deviation{
      0, reference::tolerance(usual_tolerance ? "inject" : "inject-rotated", o.format().storage), {}};
  const auto compare = [&](const Volume& volume, bool light) {
    const std::vector<float> values = volume.read(bench.session);
    const std::size_t size = values.size();
    const std::span<const double> all(*expected);
    const auto merged = light ? all.first(size) : all.last(2 * size).first(size);
    const auto alternative = light ? merged : all.last(size);
    const auto weights = [&](const glm::dvec3& w) {
      return light ? p.basis->evaluate(w) : blocking_weights(options.blocking, *p.basis, options.lobes, w);
    };
    const VolumeShape& shape = volume.shape();
    const reference::Comparison comparison =
        reference::compare_functions(values, merged, alternative, shape.n, shape.coefficients, weights);
    if (comparison.place.empty() || comparison.worst <= deviation.worst || std::isnan(deviation.worst))
      return;
    deviation.worst = comparison.worst;
    deviation.place = fmt::format("{}, {}", light ? "light" : "geometry", comparison.place);
  };
  if (p.light) compare(*p.light, true);
  if (p.geometry) compare(*p.geometry, false);
  return deviation;
}

/// Bytes of each texel's depth and normal, and of its colour for the light volume. Clearing volumes is not timed.
Cost cost_of(const Injection& p, const Inputs::CascadeViews& views) {
  const auto texels = [](const Surface& surface) {
    return static_cast<double>(surface.view.width) * surface.view.height;
  };
  const auto normal_or_colour = [](const Surface& surface) {
    return surface.format == RsmFormat::paper ? sizeof(cl_uint) : sizeof(cl_float4);
  };
  const auto bytes = [&](const Surface& surface, int fields) {
    return texels(surface) * static_cast<double>(sizeof(float) + fields * normal_or_colour(surface));
  };
  Cost cost;
  if (p.light) cost.bytes += bytes(views.rsm, 2);
  if (p.geometry) cost.bytes += bytes(views.rsm, 1) + bytes(views.camera, 1);
  cost.working_set = cost.bytes;
  for (const Volume* volume : {p.light.get(), p.geometry.get()}) {
    if (volume != nullptr) cost.working_set += static_cast<double>(volume->bytes());
  }
  return cost;
}

Job make_job(Bench& bench, const Variant& variant, const VolumeSelection& volumes) {
  Session& session = bench.session;
  const auto p = std::make_shared<Injection>(session, variant.options, volumes);
  const Inputs::CascadeViews& views = bench.inputs().views(variant.cascade.value_or(0));
  Job job;
  job.reset = [p, &session] {
    if (p->light) p->light->clear(session);
    if (p->geometry) p->geometry->clear(session);
  };
  job.run = [p, &views] { run(*p, views); };
  job.verify = [p, &bench, &views, variant] { return verify(*p, bench, views, variant); };
  job.cost = cost_of(*p, views);
  return job;
}

}  // namespace

Job inject_job(Bench& bench, const Variant& variant) {
  return make_job(bench, variant, {true, variant.options.blocked()});
}

Job inject_light_job(Bench& bench, const Variant& variant) {
  return make_job(bench, variant, {true, false});
}

Job inject_geometry_job(Bench& bench, const Variant& variant) {
  return make_job(bench, variant, {false, true});
}

}  // namespace clpv::bench
