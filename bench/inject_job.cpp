// SPDX-License-Identifier: MIT
// Stage `inject` as a job.
#include <fmt/format.h>

#include <cmath>
#include <span>

#include "basis/basis.hpp"
#include "bench/stage_jobs.hpp"
#include "pipeline/inject.hpp"
#include "reference/inject.hpp"
#include "verify/comparison.hpp"
#include "verify/tolerances.hpp"

namespace clpv::bench {
namespace {

/// What is timed: either volume, or both.
struct Parts {
  bool light, geometry;
};

struct Injection {
  std::unique_ptr<Basis> basis;
  std::unique_ptr<Volume> light, geometry;
  Injector injector;

  Injection(Session& session, const RenderOptions& o, const Parts& parts)
      : basis(make_basis(o)), injector(session, *basis, inject_options(o, false)) {
    if (parts.light)
      light = std::make_unique<Volume>(session, VolumeShape{o.grid, basis->size(), 3},
                                       "bench: injected light", o.format());
    if (parts.geometry)
      geometry =
          std::make_unique<Volume>(session, VolumeShape{o.grid + 1, blocking_size(o.blocking, *basis), 1},
                                   "bench: geometry volume", o.format());
  }
};

/// Of the volumes there are, light before geometry; of the latter also what is as right where rounding decides.
std::vector<double> reference_of(const Injection& injection, const Inputs::Seen& seen,
                                 const InjectOptions& options) {
  const Basis& basis = *injection.basis;
  const int grid = static_cast<int>(seen.grid.n);
  std::vector<double> values;
  if (injection.light) {
    reference::Volume light(grid, basis.size(), 3);
    reference::inject_light(seen.rsm_image, seen.grid, basis, options, light);
    values = std::move(light.values);
  }
  if (!injection.geometry) return values;
  reference::Volume lit(grid + 1, blocking_size(options.blocking, basis), 1), looked_at = lit;
  reference::inject_geometry(seen.rsm_image, seen.grid, basis, options, lit);
  reference::inject_geometry(seen.camera_image, seen.grid, basis, options, looked_at);
  const reference::Volume other = reference::otherwise_merged(lit, looked_at, basis, options.blocking);
  reference::merge_geometry(looked_at, basis, options.blocking, lit);
  values.insert(values.end(), lit.values.begin(), lit.values.end());
  values.insert(values.end(), other.values.begin(), other.values.end());
  return values;
}

void run(Injection& p, const Inputs::Seen& seen) {
  if (p.light) p.injector.inject_light(seen.rsm, seen.grid, *p.light);
  if (!p.geometry) return;
  p.injector.inject_geometry(seen.rsm, seen.grid, *p.geometry);
  p.injector.inject_geometry(seen.camera, seen.grid, *p.geometry);
}

Deviation verify(const Injection& p, Bench& bench, const Inputs::Seen& seen, const Variant& variant) {
  const RenderOptions& o = variant.options;
  const std::string key =
      fmt::format("inject {} {} {} {} {} {} {}", o.basis, o.lambda, lobes_of(o), p.light != nullptr,
                  p.geometry != nullptr, o.grid, variant.cascade.value_or(0));
  const InjectOptions options = inject_options(o, false);
  const auto expected = bench.expected(key, [&] { return reference_of(p, seen, options); });
  const bool plain = o.lobe == LobeKind::exact || o.storage == Storage::float16;
  Deviation deviation{0, reference::tolerance(plain ? "inject" : "inject-rotated", o.format().storage), {}};
  const auto compare = [&](const Volume& volume, bool light) {
    const std::vector<float> found = volume.read(bench.session);
    const std::span<const double> all(*expected);
    const auto merged = light ? all.first(found.size()) : all.last(2 * found.size()).first(found.size());
    const auto other = light ? merged : all.last(found.size());
    const auto weights = [&](const glm::dvec3& w) {
      return light ? p.basis->evaluate(w) : blocking_weights(options.blocking, *p.basis, options.lobes, w);
    };
    const VolumeShape& shape = volume.shape();
    const reference::Comparison apart =
        reference::compare_functions(found, merged, other, shape.n, shape.coefficients, weights);
    if (apart.place.empty() || apart.worst <= deviation.worst || std::isnan(deviation.worst)) return;
    deviation.worst = apart.worst;
    deviation.place = fmt::format("{}, {}", light ? "light" : "geometry", apart.place);
  };
  if (p.light) compare(*p.light, true);
  if (p.geometry) compare(*p.geometry, false);
  return deviation;
}

/// A texel's depth and normal once, and its colour where it is a light; volumes are zeroed outside.
Cost cost_of(const Injection& p, const Inputs::Seen& seen) {
  const auto texels = [](const Surface& surface) {
    return static_cast<double>(surface.view.width) * surface.view.height;
  };
  const auto normal_or_colour = [](const Surface& surface) {
    return surface.format == RsmFormat::paper ? sizeof(cl_uint) : sizeof(cl_float4);
  };
  const auto seen_bytes = [&](const Surface& surface, int fields) {
    return texels(surface) * static_cast<double>(sizeof(float) + fields * normal_or_colour(surface));
  };
  Cost cost;
  if (p.light) cost.bytes += seen_bytes(seen.rsm, 2);
  if (p.geometry) cost.bytes += seen_bytes(seen.rsm, 1) + seen_bytes(seen.camera, 1);
  cost.working_set = cost.bytes;
  for (const Volume* volume : {p.light.get(), p.geometry.get()}) {
    if (volume != nullptr) cost.working_set += static_cast<double>(volume->bytes());
  }
  return cost;
}

Job job_of(Bench& bench, const Variant& variant, const Parts& parts) {
  Session& session = bench.session;
  const auto p = std::make_shared<Injection>(session, variant.options, parts);
  const Inputs::Seen& seen = bench.inputs().seen(variant.cascade.value_or(0));
  Job job;
  job.reset = [p, &session] {
    if (p->light) p->light->clear(session);
    if (p->geometry) p->geometry->clear(session);
  };
  job.run = [p, &seen] { run(*p, seen); };
  job.verify = [p, &bench, &seen, variant] { return verify(*p, bench, seen, variant); };
  job.cost = cost_of(*p, seen);
  return job;
}

}  // namespace

Job inject_job(Bench& bench, const Variant& variant) {
  return job_of(bench, variant, {true, variant.options.occlusion});
}

Job inject_light_job(Bench& bench, const Variant& variant) {
  return job_of(bench, variant, {true, false});
}

Job inject_geometry_job(Bench& bench, const Variant& variant) {
  return job_of(bench, variant, {false, true});
}

}  // namespace clpv::bench
