// SPDX-License-Identifier: MIT
// Stage `gather`, the light buffer, as a job.
#include <fmt/format.h>

#include <cmath>

#include "basis/basis.hpp"
#include "bench/stage_jobs.hpp"
#include "pipeline/gather.hpp"
#include "reference/gather.hpp"
#include "reference/view.hpp"
#include "verify/comparison.hpp"
#include "verify/tolerances.hpp"

namespace clpv::bench {
namespace {

struct GatherJob {
  std::unique_ptr<Basis> basis;
  GatherOptions options;
  std::vector<ClpvGrid> grids;
  std::vector<std::unique_ptr<Volume>> volumes;
  std::vector<const Volume*> accumulated;
  Gatherer gatherer;
  Buffer irradiance;

  GatherJob(Session& session, const Variant& v)
      : basis(make_basis(v.options)),
        options(gather_options(v.options)),
        gatherer(session, *basis, v.options.transport, with_filter(options, v.filtered)) {}
  static const GatherOptions& with_filter(GatherOptions& options, bool filtered) {
    options.filtered = filtered;
    return options;
  }
};

/// Whether the device's filter interpolates.
bool filters(const Variant& v) {
  return v.options.layout == Layout::image && v.filtered;
}

/// Irradiance of every kCheckedPixels-th pixel, three channels each.
std::vector<double> reference_of(const GatherJob& p, TransportKind transport, Inputs& inputs,
                                 const SurfaceImage& camera) {
  std::vector<reference::Volume> volumes;
  std::vector<reference::Cascade> cascades;
  for (std::size_t c = 0; c < p.grids.size(); ++c) {
    volumes.push_back(
        to_reference(inputs.light(*p.basis, static_cast<int>(c)), p.options.grid, p.basis->size(), 3));
  }
  for (std::size_t c = 0; c < p.grids.size(); ++c) cascades.push_back({p.grids[c], &volumes[c]});
  std::vector<double> values;
  for (std::size_t i = 0; i < camera.depth.size(); i += kCheckedPixels) {
    const glm::dvec3 normal(glm::vec3(camera.normal[i]));
    const glm::dvec3 e =
        camera.depth[i] > 0
            ? reference::gather(*p.basis, transport, p.options, cascades,
                                reference::surface_position(camera.view, i % camera.view.width,
                                                            i / camera.view.width, camera.depth[i]),
                                normal)
            : glm::dvec3(0);
    values.insert(values.end(), {e.x, e.y, e.z});
  }
  return values;
}

Deviation compare(const std::vector<cl_float4>& device, const std::vector<double>& expected,
                  double tolerance) {
  const auto found = [&](std::size_t i) {
    return static_cast<double>(device[i / 3 * kCheckedPixels].s[i % 3]);
  };
  const auto wanted = [&](std::size_t i) { return expected[i]; };
  const reference::WorstError worst = reference::worst_difference(expected.size(), found, wanted);
  if (worst.value == 0) return {0, tolerance, {}};
  return {worst.value, tolerance,
          fmt::format("pixel {} channel {}: {:.7g}, expected {:.7g}", worst.at / 3 * kCheckedPixels,
                      worst.at % 3, found(worst.at), wanted(worst.at))};
}

}  // namespace

Job gather_job(Bench& bench, const Variant& variant) {
  Session& session = bench.session;
  const auto p = std::make_shared<GatherJob>(session, variant);
  p->grids = bench.inputs().grids();
  for (std::size_t c = 0; c < p->grids.size(); ++c) {
    p->volumes.push_back(std::make_unique<Volume>(session,
                                                  VolumeShape{variant.options.grid, p->basis->size(), 3},
                                                  "bench: accumulated light", variant.options.format()));
    p->volumes.back()->write(session, bench.inputs().light(*p->basis, static_cast<int>(c)));
    p->accumulated.push_back(p->volumes.back().get());
  }
  const Inputs::Seen& seen = bench.inputs().seen(0);
  const std::size_t pixels = seen.camera_image.depth.size(), bytes = pixels * sizeof(cl_float4);
  p->irradiance = session.buffer(bytes, "bench: irradiance");
  Job job;
  job.reset = [p, &session, bytes] { session.fill_zero(p->irradiance, bytes); };
  job.run = [p, &seen] { p->gatherer.gather(seen.camera, p->grids, p->accumulated, p->irradiance); };
  job.verify = [p, &bench, &seen, variant, pixels] {
    const RenderOptions& o = variant.options;
    const std::string key = fmt::format("gather {} {} {} {} {} {}", o.basis, o.lambda, name_of(o.transport),
                                        lobes_of(o), name_of(o.evaluate), o.grid);
    const auto expected =
        bench.expected(key, [&] { return reference_of(*p, o.transport, bench.inputs(), seen.camera_image); });
    return compare(bench.session.read<cl_float4>(p->irradiance, pixels), *expected,
                   reference::tolerance(filters(variant) ? "gather-filter" : "gather", o.format().storage));
  };
  const VolumeFormat format = variant.options.format();
  const int n = p->basis->size();
  double volumes = 0;  // read once; buffers are packed first: read, written and read again
  for (const auto& volume : p->volumes)
    volumes += static_cast<double>(volume->bytes()) * (format.layout == Layout::image ? 1 : 3);
  job.cost.bytes = static_cast<double>(pixels) * (sizeof(float) + 2 * sizeof(cl_float4)) + volumes;
  job.cost.working_set = job.cost.bytes;
  // Of a pixel within one cascade: eight cells, or one filtered texel in their place. Buffers are read packed, two
  // coefficients of three channels at once.
  const double texels = 3.0 * accesses_per_cell(format, n);
  job.cost.reads_per_cell = format.layout != Layout::image ? 8.0 * ((n + 1) / 2)
                            : variant.filtered             ? texels
                                                           : 8 * texels;
  // Trilinear weights once, then 8 multiply-adds a coefficient and channel unless the filter does them, and g(n) . c.
  job.cost.flops = static_cast<double>(pixels) * 3 * n * (filters(variant) ? 2 : 2 * 8 + 2);
  return job;
}

}  // namespace clpv::bench
