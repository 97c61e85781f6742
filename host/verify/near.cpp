// SPDX-License-Identifier: MIT
// Near field: kernels against CPU reference, on random triangles with textures, holes and emission,
// under all kinds of light, in random light of three cascades. Pixels that rounding may decide are
// left out.
#include "pipeline/gather/near.hpp"

#include <fmt/format.h>

#include <memory>
#include <random>

#include "basis/sweep.hpp"
#include "pipeline/gather/gather.hpp"
#include "pipeline/raster/view.hpp"
#include "reference/gather.hpp"
#include "reference/near.hpp"
#include "verify/check.hpp"
#include "verify/expected.hpp"
#include "verify/inputs.hpp"
#include "verify/tolerances.hpp"

namespace clpv::verify {
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
reference::MappedLight near_light(const ClpvLight& light, bool shadows, std::mt19937& random) {
  reference::MappedLight mapped{light, {}};
  if (!shadows) return mapped;
  for (const ClpvView& view : shadow_views(light, {{-30, -30, -30}, {30, 30, 30}}, kNearMap)) {
    reference::ShadowMap& map = mapped.maps.emplace_back(reference::ShadowMap{view, {}});
    for (unsigned texel = 0; texel < kNearMap * kNearMap; ++texel)
      map.depth.push_back(random() % 3 == 0 ? 1e-3f : 0.0f);
  }
  return mapped;
}

std::vector<reference::MappedLight> near_lights(std::mt19937& random) {
  const ClpvLight sun{
      {}, CLPV_LIGHT_DIRECTIONAL, {2 / 7.0f, -6 / 7.0f, 3 / 7.0f}, 0, {3, 2, 1}, 0, 0, 0, {}, {}};
  const ClpvLight point{{5, 1.5f, 0.3f}, CLPV_LIGHT_POINT, {}, 0, {60, 50, 40}, 0, 0, 0, {}, {}};
  return {near_light(sun, true, random), near_light(point, true, random),
          near_light(sun, false, random)};
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
  const std::vector<cl_float4> found = session.read<cl_float4>(irradiance, image.depth.size());
  std::vector<double> expected, recorded;
  std::size_t certain = 0;
  for (std::size_t i = 0; i < found.size(); ++i) {
    const bool unsure = wanted.uncertain[i];
    const glm::dvec3 there(found[i].s[0], found[i].s[1], found[i].s[2]);
    certain += unsure ? 0 : 1;
    append_pixel(expected, unsure ? there : wanted.irradiance[i], found[i].s[3]);
    append_pixel(recorded, unsure ? glm::dvec3(NAN) : wanted.irradiance[i], NAN);
  }
  const double share = static_cast<double>(certain) / static_cast<double>(found.size()),
               allowed = tolerance("near", variant.format.storage);
  if (share < kLeastCertain)
    return {1, allowed,
            fmt::format("rounding may decide all but {:.0f} % of the pixels", 100 * share)};
  expect_pixels(session, irradiance, recorded, allowed);
  return compare_pixels(found, expected, image.view.width, allowed);
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

}  // namespace clpv::verify
