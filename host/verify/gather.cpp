// SPDX-License-Identifier: MIT
// Gathering: kernels against CPU reference. Checks use random light in three nested cascades, and
// surfaces in and around them.

#include "pipeline/gather/gather.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <random>

#include "basis/sweep.hpp"
#include "pipeline/frame/cascade.hpp"
#include "pipeline/gather/medium.hpp"
#include "pipeline/gather/near.hpp"
#include "pipeline/raster/view.hpp"
#include "reference/gather.hpp"
#include "reference/medium.hpp"
#include "reference/near.hpp"
#include "reference/view.hpp"
#include "verify/check.hpp"
#include "verify/inputs.hpp"
#include "verify/jobs.hpp"
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

std::string_view compared_as(const GatherOptions& options, TransportKind transport) {
  if (options.gather == Gathering::visible) return "gather-visible";
  const bool by_device =
      options.format.layout == Layout::image && options.filtered && has_faces(transport);
  return by_device ? "gather-filter" : "gather";
}

/// Expected irradiance of the compared pixels, four numbers each.
std::vector<double> expected_pixels(const GatherWork& p) {
  const GatherProblem& q = p.problem;
  std::vector<double> values;
  for (const glm::dvec3& irradiance :
       reference::gather(*q.basis, q.transport, q.options, p.light.cascades, *q.image, q.every))
    append_pixel(values, irradiance, 0);
  return values;
}

}  // namespace

Job gather_job(Session& session, const GatherProblem& problem, const Share& share) {
  const auto p = std::make_shared<GatherWork>(session, problem);
  Job job;
  job.reset = [p, &session] { session.fill_zero(p->irradiance, p->bytes()); };
  job.run = [p] { p->gatherer.gather(p->problem.camera, p->light.gathered(), p->irradiance); };
  job.compare = [p, &session, share] {
    const GatherProblem& q = p->problem;
    const Values expected = share([&] { return expected_pixels(*p); });
    const double allowed = tolerance(compared_as(q.options, q.transport), q.options.format.storage);
    return compare_pixels(session, p->irradiance, *expected, q.image->view.width, allowed, q.every);
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

// Near field: kernels against CPU reference, on random triangles with textures, holes and emission,
// under all kinds of light, in random light of three cascades. Pixels that rounding may decide are
// left out.

namespace {

constexpr int kNearGrid = 9, kNearCascades = 3;
constexpr double kNearFinestEdge = 6;   // [m]
constexpr unsigned kNearMap = 24;       // texels along each side of a shadow map
constexpr double kLeastCertain = 0.25;  // share of pixels that must be compared

/// The camera looks at two planes across its axis, and at random surfaces between them.
SurfaceImage near_surfaces(std::mt19937& random) {
  SurfaceImage image = random_surfaces(random);
  const ClpvView& view = image.view;
  const glm::dvec3 towards(-view.forward[0], -view.forward[1], -view.forward[2]),
      tilted = glm::normalize(towards + glm::dvec3(0.1, 0.6, -0.4));
  for (std::size_t pixel = 0; pixel < image.depth.size(); ++pixel) {
    if (pixel % 7 == 3 || image.depth[pixel] == 0) continue;
    image.depth[pixel] = pixel % view.width < view.width / 2 ? 2.13f : 3.57f;
    image.normal[pixel] = stored_normal(towards, pixel % 5 == 0 ? tilted : towards);
  }
  return image;
}

/// Maps are empty or, texel by texel at random, block all light: no depth is close to that of a
/// surface.
std::vector<reference::MappedLight> near_lights(std::mt19937& random) {
  const auto depth = [&] { return random() % 3 == 0 ? 1e-3f : 0.0f; };
  return {mapped_light(kSun, kWideBounds, kNearMap, kNearMap, depth),
          mapped_light(kPoint, kWideBounds, kNearMap, kNearMap, depth),
          {kSun, {}}};
}

struct NearCase {
  std::string name;
  int step = 1, rays = 4;
  bool reflects = false;
  Gathering gather = Gathering::visible;
  VolumeFormat format = {};
};

Deviation compare_near(Session& session, const NearCase& variant) {
  std::mt19937 random(23);
  const std::unique_ptr<Basis> basis = swept_basis();
  const SurfaceImage image = near_surfaces(random);
  SceneData scene = triangle_soup();
  scene.materials[0].emissive[0] = 2, scene.materials[0].emissive[1] = 1;
  const reference::Materials materials(scene);
  const std::vector<reference::MappedLight> lights = near_lights(random);
  std::vector<std::uint8_t> occluded = random_occlusion(kNearCascades, kNearGrid, random);
  if (variant.gather != Gathering::visible) occluded.clear();
  const CascadeLight cascades = random_cascades(*basis, kNearCascades, kNearFinestEdge, kNearGrid,
                                                true, std::move(occluded), random);
  const CascadesOnDevice light(session, cascades, variant.format);
  const NearOptions options{.gather = {.grid = kNearGrid,
                                       .gather = variant.gather,
                                       .gather_offset = 0.25,
                                       .format = variant.format,
                                       .packed = true},
                            .step = variant.step,
                            .rays = variant.rays,
                            .reflects = variant.reflects};

  const Surface camera = upload_surface(session, image);
  Buffer irradiance = session.buffer(image.depth.size() * sizeof(cl_float4), "check: irradiance");
  Gatherer gatherer(session, *basis, TransportKind::sweep, options.gather);
  gatherer.gather(camera, light.gathered(), irradiance);
  const SceneBuffers buffers = upload_scene(session, scene);
  clpv::NearField field(session, *basis, scene, buffers, options);
  field.trace(camera, gatherer);
  field.add(camera, gatherer, on_device(session, lights), irradiance);

  const reference::NearResult wanted = reference::near(
      *basis, options, {scene, materials, lights, light.cascades}, image,
      reference::gather(*basis, TransportKind::sweep, options.gather, light.cascades, image));
  std::vector<double> expected;
  for (const glm::dvec3& irradiance_there : wanted.irradiance)
    append_pixel(expected, irradiance_there, 0);
  const auto certain = static_cast<double>(std::ranges::count(wanted.uncertain, false));
  const double share = certain / static_cast<double>(wanted.uncertain.size()),
               allowed = tolerance("near", variant.format.storage);
  if (share < kLeastCertain)
    return {1, allowed,
            fmt::format("rounding may decide all but {:.0f} % of the pixels", 100 * share)};
  return compare_pixels(session, irradiance, expected, image.view.width, allowed, 1,
                        wanted.uncertain);
}

// Light scattered by a medium: kernels against CPU reference, under a sun, a spot and a point light
// and in random light of two cascades.

constexpr int kMediumGrid = 9, kMediumCascades = 2;
constexpr double kMediumFinestEdge = 6;  // [m]

const ClpvMedium kFog{{-2, -1.5f, -7},     {4, 3, 2}, {0.1f, 0.3f, 0.5f},
                      {0.15f, 0.3f, 0.9f}, 0.5f,      {}};
const ClpvMedium kDust{{-20, -20, -20},       {20, 20, 20}, {1e-5f, 2e-5f, 0},
                       {1e-5f, 2e-5f, 1e-5f}, -0.3f,        {}};

Deviation compare_medium(Session& session, const ClpvMedium& medium) {
  std::mt19937 random(31);
  const std::unique_ptr<Basis> basis = swept_basis();
  const SurfaceImage image = random_surfaces(random);
  const std::vector<reference::MappedLight> lights = lights_in(medium);
  const CascadeLight cascades =
      random_cascades(*basis, kMediumCascades, kMediumFinestEdge, kMediumGrid, true, {}, random);
  const CascadesOnDevice light(session, cascades, {});
  const MediumOptions options{.gather = {.grid = kMediumGrid, .packed = true}};

  const Surface camera = upload_surface(session, image);
  Buffer pixels = session.buffer(image.depth.size() * sizeof(cl_float4), "check: irradiance");
  Gatherer gatherer(session, *basis, TransportKind::sweep, options.gather);
  gatherer.gather(camera, light.gathered(), pixels);
  MediumLight scattered(session, *basis, medium, options);
  scattered.scatter(camera, gatherer, on_device(session, lights));
  scattered.add(camera, true, pixels);

  std::vector<double> expected;
  for (const glm::dvec3& wanted :
       reference::scattered_light(*basis, options, {medium, lights, light.cascades}, image))
    append_pixel(expected, wanted, 1);
  return compare_pixels(session, pixels, expected, image.view.width, tolerance("medium"));
}

}  // namespace

Cases near_cases(const CheckScope& scope) {
  Cases cases;
  const auto add = [&](const NearCase& variant) {
    cases.push_back(deviation_case(Stage::near, variant.name, [variant](Session& session) {
      return compare_near(session, variant);
    }));
  };
  add({.name = "quarter", .step = 4});
  add({.name = "reflects", .reflects = true});
  if (!scope.thorough) return cases;
  add({.name = "full"});
  add({.name = "half", .step = 2});
  add({.name = "eighth, 2 rays", .step = 8, .rays = 2});
  add({.name = "all cells", .gather = Gathering::all});
  add({.name = "half numbers", .format = {Layout::soa, Storage::float16}});
  return cases;
}

Cases medium_cases(const CheckScope&) {
  return {deviation_case(Stage::medium, "fog",
                         [](Session& session) { return compare_medium(session, kFog); }),
          deviation_case(Stage::medium, "dust",
                         [](Session& session) { return compare_medium(session, kDust); })};
}

}  // namespace clpv::verify
