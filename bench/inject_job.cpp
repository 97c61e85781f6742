// SPDX-License-Identifier: MIT
// Stage `inject` as a job.
#include <fmt/format.h>

#include <cmath>

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

/// Directions in which functions are compared: the axes and the corners of a cube.
std::vector<glm::dvec3> directions() {
  std::vector<glm::dvec3> found;
  for (int c = 0; c < 8; ++c)
    found.push_back(glm::normalize(glm::dvec3(c & 1, c >> 1 & 1, c >> 2) * 2.0 - 1.0));
  for (int axis = 0; axis < 6; ++axis) {
    glm::dvec3 d(0);
    d[axis / 2] = axis % 2 == 0 ? 1 : -1;
    found.push_back(d);
  }
  return found;
}

/// Functions, not coefficients, are compared: an ill-conditioned Gram matrix tells coefficients apart that hardly
/// differ as functions. `n` samples along each axis; of one volume. `other` is as right as `CPU reference`.
void compare(const Basis& basis, const std::vector<float>& device, const double* expected,
             const double* other, int n, const char* what, Deviation& deviation) {
  const auto samples = static_cast<std::size_t>(n) * n * n, size = static_cast<std::size_t>(basis.size());
  double largest = 0;
  reference::WorstError worst;
  for (const glm::dvec3& w : directions()) {
    const std::vector<double> b = basis.evaluate(w);
    for (std::size_t at = 0; at < device.size() / size; ++at) {
      double found = 0, wanted = 0, or_wanted = 0;
      for (std::size_t i = 0; i < size; ++i) {
        const std::size_t index = (at / samples * size + i) * samples + at % samples;
        found += b[i] * device[index];
        wanted += b[i] * expected[index];
        or_wanted += b[i] * other[index];
      }
      largest = std::max(largest, std::abs(wanted));
      worst.take(std::min(std::abs(found - wanted), std::abs(found - or_wanted)), at);
    }
  }
  const double error = worst.value / largest;
  if (worst.value == 0 || error <= deviation.worst || std::isnan(deviation.worst)) return;
  deviation.worst = error;
  const std::size_t cell = worst.at % samples, side = static_cast<std::size_t>(n);
  deviation.place =
      fmt::format("{}, sample {},{},{} channel {}: off by {:.3g} of the largest value", what, cell % side,
                  cell / side % side, cell / side / side, worst.at / samples, error);
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
  const auto expected = bench.expected(key, [&] { return reference_of(p, seen, inject_options(o, false)); });
  const bool plain = o.lobe == LobeKind::exact || o.storage == Storage::float16;
  Deviation deviation{0, reference::tolerance(plain ? "inject" : "inject-rotated", o.format().storage), {}};
  std::size_t before = 0;
  if (p.light) {
    const std::vector<float> light = p.light->read(bench.session);
    compare(*p.basis, light, expected->data(), expected->data(), o.grid, "light", deviation);
    before = light.size();
  }
  if (p.geometry) {
    const std::vector<float> geometry = p.geometry->read(bench.session);
    const double* merged = expected->data() + before;
    compare(*p.basis, geometry, merged, merged + geometry.size(), o.grid + 1, "geometry", deviation);
  }
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
