// SPDX-License-Identifier: MIT
// Gathering: kernels against CPU reference. Checks use random light in three nested cascades, and
// surfaces in and around them.
#include "verify/gather.hpp"

#include <fmt/format.h>

#include <cmath>
#include <memory>
#include <random>

#include "basis/sweep.hpp"
#include "pipeline/gather/gather.hpp"
#include "reference/gather.hpp"
#include "reference/view.hpp"
#include "verify/check.hpp"
#include "verify/expected.hpp"
#include "verify/tolerances.hpp"

namespace clpv::verify {
namespace {

constexpr int kGatherGrid = 9;  // odd, so that no pitch is a power of two
constexpr int kCascades = 3;
constexpr double kFinestEdge = 4;  // [m]; the coarsest is 16 m across

/// Volumes and kernels of one gathering.
struct GatherWork {
  GatherProblem problem;
  CascadesOnDevice light;
  Gatherer gatherer;
  Buffer irradiance;

  GatherWork(Session& session, const GatherProblem& p)
      : problem(p),
        light(session, problem.cascades, p.options.format),
        gatherer(session, *p.basis, p.transport, p.options),
        irradiance(session.buffer(bytes(), "irradiance")) {}
  std::size_t pixels() const { return problem.image->depth.size(); }
  std::size_t bytes() const { return pixels() * sizeof(cl_float4); }
};

/// Returns true if the device's image filter interpolates.
bool filtered_by_device(const GatherOptions& options, TransportKind transport) {
  return options.format.layout == Layout::image && options.filtered &&
         options.gather == Gathering::all && has_faces(transport);
}

std::string_view compared_as(const GatherOptions& options, TransportKind transport) {
  if (options.gather == Gathering::visible) return "gather-visible";
  return filtered_by_device(options, transport) ? "gather-filter" : "gather";
}

/// Expected irradiance of the compared pixels, four numbers each.
std::vector<double> expected_pixels(const GatherWork& p) {
  const GatherProblem& q = p.problem;
  const SurfaceImage& image = *q.image;
  std::vector<double> values;
  for (std::size_t i = 0; i < image.depth.size(); i += q.every) {
    const glm::dvec3 at = reference::surface_position(image.view, i, double{image.depth[i]});
    const glm::dvec3 e =
        image.depth[i] > 0
            ? reference::gather(*q.basis, q.transport, q.options, p.light.cascades, at,
                                glm::dvec3(image.normal[i]), lift_normal(image.normal[i]),
                                reference::towards_eye(image.view, at))
            : glm::dvec3(0);
    append_pixel(values, e, 0);
  }
  return values;
}

Cost cost_of(const GatherWork& p) {
  const GatherOptions& o = p.problem.options;
  const int n = p.problem.basis->size();
  const auto pixels = static_cast<double>(p.pixels());
  Cost cost;
  cost.bytes = pixels * (sizeof(float) + 2 * sizeof(cl_float4));
  for (const Volume& volume :
       p.light.stored)  // images are read once; buffers are packed: read, written, read again
    cost.bytes += static_cast<double>(volume.bytes()) * (o.format.layout == Layout::image ? 1 : 3);
  cost.working_set = cost.bytes;
  // Reads per pixel in one cascade: eight cells, or one filtered texel. A read of packed buffers
  // has two coefficients of three channels.
  const double texels = kChannels * accesses_per_cell(o.format, n);
  cost.reads_per_cell = o.format.layout != Layout::image ? 8.0 * ((n + 1) / 2)
                        : o.filtered                     ? texels
                                                         : 8 * texels;
  // Per coefficient and channel: 8 multiply-adds of the trilinear interpolation, unless the filter
  // does them, and one of the dot product g(n) . c.
  cost.flops =
      pixels * kChannels * n * (filtered_by_device(o, p.problem.transport) ? 2 : 2 * 8 + 2);
  return cost;
}

}  // namespace

Job gather_job(Session& session, const GatherProblem& problem, const Share& share) {
  const auto p = std::make_shared<GatherWork>(session, problem);
  Job job;
  job.cost = cost_of(*p);
  job.reset = [p, &session] { session.fill_zero(p->irradiance, p->bytes()); };
  job.run = [p] { p->gatherer.gather(p->problem.camera, p->light.gathered(), p->irradiance); };
  job.compare = [p, &session, share] {
    const GatherProblem& q = p->problem;
    const Values expected = share([&] { return expected_pixels(*p); });
    const double allowed = tolerance(compared_as(q.options, q.transport), q.options.format.storage);
    expect_pixels(session, p->irradiance, *expected, allowed, q.every);
    return compare_pixels(session.read<cl_float4>(p->irradiance, p->pixels()), *expected,
                          q.image->view.width, allowed, q.every);
  };
  return job;
}

GatherProblem random_gathering(Session& session, const std::shared_ptr<const Basis>& basis,
                               TransportKind transport, const GatherOptions& options) {
  std::mt19937 random(11);
  SurfaceImage image = random_surfaces(random);
  std::vector<std::uint8_t> occluded = random_occlusion(kCascades, options.grid, random);
  if (options.gather != Gathering::visible) occluded.clear();
  CascadeLight light = random_cascades(*basis, kCascades, kFinestEdge, options.grid,
                                       !has_faces(transport), std::move(occluded), random);
  std::vector<reference::Cascade> cascades;
  for (std::size_t c = 0; c < light.grids.size(); ++c)
    cascades.push_back(
        {light.grids[c], nullptr, light.occluded.data() + c * light.occluded.size() / kCascades});
  for (std::size_t pixel = 0; pixel < image.depth.size(); ++pixel) {
    const glm::dvec3 at =
        reference::surface_position(image.view, pixel, double{image.depth[pixel]});
    if (rounding_decides(*basis, options.lobes, glm::dvec3(image.normal[pixel])) ||
        reference::rounding_decides(options, cascades, at, options.gather_offset,
                                    lift_normal(image.normal[pixel]),
                                    reference::towards_eye(image.view, at)))
      image.depth[pixel] = 0;
  }
  return {basis,
          transport,
          options,
          std::move(light),
          upload_surface(session, image),
          std::make_shared<const SurfaceImage>(image)};
}

Cases gather_cases(const CheckScope& scope) {
  Cases cases;
  const auto add = [&](const std::string& basis, TransportKind transport, const std::string& name,
                       GatherOptions options) {
    options.grid = kGatherGrid;
    cases.push_back(
        job_case(Stage::gather, fmt::format("{}/{}/{}", basis, name_of(transport), name),
                 [=](Session& session) {
                   return gather_job(
                       session, random_gathering(session, make_basis(basis), transport, options));
                 }));
  };
  const GatherOptions visible{.gather = Gathering::visible};
  for (const std::string& name : scope.bases) {
    if (!scope.thorough && name == "sh2") continue;  // sh3 has the same code
    add(name, TransportKind::sampled, "plain", {});
    if (scope.thorough || name == "sh3") add(name, TransportKind::sampled, "visible", visible);
    const std::unique_ptr<Basis> basis = make_basis(name);
    if (basis->centres().empty()) continue;  // no table
    if (!scope.thorough && basis->size() > 4) continue;
    GatherOptions table{.lobes = {.table_functions = true}};
    add(name, TransportKind::sampled, "table", table);
    table.table = TableStorage::image;
    add(name, TransportKind::sampled, "table image", table);
  }
  const std::string swept = swept_basis()->name();  // all bases of swept light
  add(swept, TransportKind::sweep, "plain", {});
  add(swept, TransportKind::sweep, "visible", visible);
  for (const VolumeFormat& format :
       scope.formats) {  // images both with the device's filter and from texels
    GatherOptions options{.format = format};
    std::string name = format_name(format);
    if (format.layout == Layout::image) {
      add("sh2", TransportKind::sweep, name + " filter", options);
      name += " texels";
      options.filtered = false;
    }
    add("sh2", TransportKind::sweep, name, options);
    options.gather = Gathering::visible;
    add("sh2", TransportKind::sweep, name + " visible", options);
  }
  return cases;
}

}  // namespace clpv::verify
