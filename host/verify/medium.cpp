// SPDX-License-Identifier: MIT
// Light scattered by a medium: kernels against CPU reference, under a sun, a spot and a point light and in random light of
// two cascades. A map is empty or blocks everything, so that rounding decides no texel.
#include "pipeline/medium.hpp"

#include <memory>
#include <random>

#include "basis/sweep.hpp"
#include "pipeline/cascade.hpp"
#include "pipeline/gather.hpp"
#include "pipeline/view.hpp"
#include "reference/medium.hpp"
#include "verify/check.hpp"
#include "verify/inputs.hpp"
#include "verify/tolerances.hpp"

namespace clpv::reference {
namespace {

constexpr int kMediumGrid = 9, kMediumCascades = 2;
constexpr double kMediumFinestEdge = 6;  // [m]
constexpr unsigned kMediumMap = 16;      // texels along each side of a shadow map

struct MediumVariant {
  std::string name;
  ClpvMedium medium;
};

const ClpvMedium kFog{{-2, -1.5f, -7}, {4, 3, 2}, {0.1f, 0.3f, 0.5f}, {0.15f, 0.3f, 0.9f}, 0.5f, {}};
const ClpvMedium kDust{{-20, -20, -20}, {20, 20, 20}, {1e-5f, 2e-5f, 0}, {1e-5f, 2e-5f, 1e-5f}, -0.3f, {}};

MappedLight mapped(ClpvLight light, const ClpvMedium& medium, float depth) {
  light.medium = medium;
  MappedLight result{light, {}};
  for (const ClpvView& view : shadow_views(light, {{-30, -30, -30}, {30, 30, 30}}, kMediumMap))
    result.maps.push_back({view, std::vector<float>(kMediumMap * kMediumMap, depth)});
  return result;
}

std::vector<MappedLight> medium_lights(const ClpvMedium& medium) {
  const ClpvLight sun{{}, CLPV_LIGHT_DIRECTIONAL, {2 / 7.0f, -6 / 7.0f, 3 / 7.0f}, 0, {3, 2, 1}, 0, 0, {},
                      {}};
  const ClpvLight point{{1, 1.5f, -2.3f}, CLPV_LIGHT_POINT, {}, 0, {6, 5, 4}, 0, 0, {}, {}};
  const ClpvLight spot{{-1, 2.5f, -3}, CLPV_LIGHT_SPOT, {0.6f, -0.8f, 0}, 9, {20, 30, 20}, 2, -1, {}, {}};
  MappedLight unshadowed{spot, {}};
  unshadowed.light.medium = medium;
  return {mapped(sun, medium, 0), mapped(sun, medium, 1e-3f), mapped(point, medium, 0), unshadowed};
}

CheckResult check_one_medium(Session& session, const MediumVariant& variant) {
  std::mt19937 random(31);
  const std::unique_ptr<Basis> basis = swept_basis();
  const SurfaceImage image = random_surfaces(random);
  const std::vector<MappedLight> lights = medium_lights(variant.medium);
  const std::vector<ClpvGrid> grids =
      cascade_grids({0.1f, 0.2f, 0.3f}, kMediumCascades, kMediumFinestEdge, kMediumGrid);
  std::vector<Volume> light;
  std::vector<clpv::Volume> lit;
  for (int c = 0; c < kMediumCascades; ++c) {
    light.push_back(random_light(*basis, kMediumGrid, random));
    lit.push_back(on_device(session, light.back(), {}));
  }
  std::vector<const clpv::Volume*> volumes;
  std::vector<Cascade> cascades;
  for (int c = 0; c < kMediumCascades; ++c) {
    volumes.push_back(&lit[c]);
    cascades.push_back({grids[c], &light[c], nullptr});
  }
  const MediumOptions options{.gather = {.grid = kMediumGrid, .packed = true}};

  const Surface camera = upload_surface(session, image);
  Buffer pixels = session.buffer(image.depth.size() * sizeof(cl_float4), "check: irradiance");
  Gatherer gatherer(session, *basis, TransportKind::sweep, options.gather);
  gatherer.gather(camera, grids, volumes, pixels);
  std::vector<ShadowedLight> shadowed;
  for (const MappedLight& each : lights) {
    ShadowedLight& there = shadowed.emplace_back(ShadowedLight{each.light, {}, {}});
    for (const ShadowMap& map : each.maps) {
      there.views.push_back(map.view);
      there.depths.push_back(session.upload(map.depth, "check: shadow map"));
    }
  }
  MediumLight scattered(session, *basis, variant.medium, options);
  scattered.scatter(camera, gatherer, shadowed, 1, nullptr);
  scattered.add(camera, true, pixels);

  std::vector<glm::dvec4> expected;
  for (const glm::dvec3& wanted : scattered_light(*basis, options, {variant.medium, lights, cascades}, image))
    expected.emplace_back(wanted, 1);
  CheckResult result = compare_pixels(session.read<cl_float4>(pixels, image.depth.size()), expected,
                                      image.view.width, "medium", variant.name);
  result.allowed = tolerance("medium", Storage::float32);
  return result;
}

}  // namespace

CheckResults check_medium(Session& session, const CheckScope& scope) {
  CheckResults results;
  for (const MediumVariant& variant : {MediumVariant{"fog", kFog}, MediumVariant{"dust", kDust}})
    compare_selected(scope, "medium", variant.name, results,
                     [&] { return check_one_medium(session, variant); });
  return results;
}

}  // namespace clpv::reference
