// SPDX-License-Identifier: MIT
// Job of stage `gather`: accumulated volumes to the light buffer.
#include <fmt/format.h>

#include <cmath>

#include "basis/basis.hpp"
#include "bench/stage_jobs.hpp"
#include "pipeline/gather/gather.hpp"
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

/// Returns true if the device's image filter interpolates.
bool filtered_by_device(const Variant& v) {
  return v.options.layout == Layout::image && v.filtered;
}

/// Expected irradiance of every kCheckedPixels-th pixel, three channels each.
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
  const auto value = [&](std::size_t i) {
    return static_cast<double>(device[i / 3 * kCheckedPixels].s[i % 3]);
  };
  const auto expected_value = [&](std::size_t i) { return expected[i]; };
  const reference::WorstError worst = reference::worst_difference(expected.size(), value, expected_value);
  if (worst.value == 0) return {0, tolerance, {}};
  return {worst.value, tolerance,
          fmt::format("pixel {} channel {}: {:.7g}, expected {:.7g}", worst.at / 3 * kCheckedPixels,
                      worst.at % 3, value(worst.at), expected[worst.at])};
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
  const Inputs::CascadeViews& views = bench.inputs().views(0);
  const std::size_t pixels = views.camera_image.depth.size(), bytes = pixels * sizeof(cl_float4);
  p->irradiance = session.buffer(bytes, "bench: irradiance");
  Job job;
  job.reset = [p, &session, bytes] { session.fill_zero(p->irradiance, bytes); };
  job.run = [p, &views] { p->gatherer.gather(views.camera, {p->grids, p->accumulated}, p->irradiance); };
  job.verify = [p, &bench, &views, variant, pixels] {
    const RenderOptions& o = variant.options;
    const std::string key = fmt::format("gather {} {} {} {} {} {}", o.basis, o.lambda, name_of(o.transport),
                                        lobes_of(o), name_of(o.evaluate), o.grid);
    const auto expected = bench.expected(
        key, [&] { return reference_of(*p, o.transport, bench.inputs(), views.camera_image); });
    return compare(
        bench.session.read<cl_float4>(p->irradiance, pixels), *expected,
        reference::tolerance(filtered_by_device(variant) ? "gather-filter" : "gather", o.format().storage));
  };
  const VolumeFormat format = variant.options.format();
  const int n = p->basis->size();
  double volumes = 0;  // images are read once; buffers are packed first: read, written and read again
  for (const auto& volume : p->volumes)
    volumes += static_cast<double>(volume->bytes()) * (format.layout == Layout::image ? 1 : 3);
  job.cost.bytes = static_cast<double>(pixels) * (sizeof(float) + 2 * sizeof(cl_float4)) + volumes;
  job.cost.working_set = job.cost.bytes;
  // Reads per pixel in one cascade: eight cells, or one filtered texel. A read of packed buffers has two coefficients
  // of three channels.
  const double texels = 3.0 * accesses_per_cell(format, n);
  job.cost.reads_per_cell = format.layout != Layout::image ? 8.0 * ((n + 1) / 2)
                            : variant.filtered             ? texels
                                                           : 8 * texels;
  // Per coefficient and channel: 8 multiply-adds of the trilinear interpolation, unless the filter does them, and one of
  // the dot product g(n) . c.
  job.cost.flops = static_cast<double>(pixels) * 3 * n * (filtered_by_device(variant) ? 2 : 2 * 8 + 2);
  return job;
}

}  // namespace clpv::bench
