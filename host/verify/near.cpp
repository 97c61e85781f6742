// SPDX-License-Identifier: MIT
// Near field: kernels against CPU reference, on random triangles with textures, holes and emission, under all kinds of
// light, in random light of three cascades. Pixels that rounding may decide are left out.
#include "pipeline/gather/near.hpp"

#include <fmt/format.h>

#include <memory>
#include <random>

#include "basis/sweep.hpp"
#include "pipeline/frame/cascade.hpp"
#include "pipeline/gather/gather.hpp"
#include "pipeline/raster/view.hpp"
#include "pipeline/voxels/visibility.hpp"
#include "reference/gather.hpp"
#include "reference/near.hpp"
#include "verify/check.hpp"
#include "verify/inputs.hpp"
#include "verify/tolerances.hpp"

namespace clpv::reference {
namespace {

constexpr int kNearGrid = 9, kNearCascades = 3;
constexpr double kNearFinestEdge = 6;   // [m]
constexpr unsigned kNearMap = 24;       // texels along each side of a shadow map
constexpr double kLeastCertain = 0.25;  // share of pixels that must be compared

/// The camera looks at two planes across its axis, and at random surfaces between them.
SurfaceImage near_surfaces(std::mt19937& random) {
  SurfaceImage image = random_surfaces(random);
  const ClpvView& view = image.view;
  const glm::vec4 towards(-view.forward[0], -view.forward[1], -view.forward[2], 0);
  for (std::size_t pixel = 0; pixel < image.depth.size(); ++pixel) {
    if (pixel % 7 == 3 || image.depth[pixel] == 0) continue;
    image.depth[pixel] = pixel % view.width < view.width / 2 ? 2.13f : 3.57f;
    image.normal[pixel] = towards;
  }
  return image;
}

/// Maps are empty or, texel by texel at random, block all light: no depth is close to that of a surface.
MappedLight near_light(const ClpvLight& light, bool shadows, std::mt19937& random) {
  MappedLight mapped{light, {}};
  if (!shadows) return mapped;
  for (const ClpvView& view : shadow_views(light, {{-30, -30, -30}, {30, 30, 30}}, kNearMap)) {
    ShadowMap& map = mapped.maps.emplace_back(ShadowMap{view, {}});
    for (unsigned texel = 0; texel < kNearMap * kNearMap; ++texel)
      map.depth.push_back(random() % 3 == 0 ? 1e-3f : 0.0f);
  }
  return mapped;
}

std::vector<MappedLight> near_lights(std::mt19937& random) {
  const ClpvLight sun{{}, CLPV_LIGHT_DIRECTIONAL, {2 / 7.0f, -6 / 7.0f, 3 / 7.0f}, 0, {3, 2, 1}, 0, 0, {},
                      {}};
  const ClpvLight point{{5, 1.5f, 0.3f}, CLPV_LIGHT_POINT, {}, 0, {60, 50, 40}, 0, 0, {}, {}};
  return {near_light(sun, true, random), near_light(point, true, random), near_light(sun, false, random)};
}

struct NearVariant {
  std::string name;
  int step = 1, rays = 4;
  bool reflects = false;
  Gathering gather = Gathering::visible;
  VolumeFormat format = {};
};

CheckResult check_one_near(Session& session, const NearVariant& variant) {
  std::mt19937 random(23);
  const std::unique_ptr<Basis> basis = swept_basis();
  const SurfaceImage image = near_surfaces(random);
  Scene scene = triangle_soup();
  scene.materials[0].emissive[0] = 2, scene.materials[0].emissive[1] = 1;
  const Materials materials(scene);
  const std::vector<MappedLight> lights = near_lights(random);
  const std::vector<ClpvGrid> grids =
      cascade_grids({0.1f, 0.2f, 0.3f}, kNearCascades, kNearFinestEdge, kNearGrid);
  std::vector<std::uint8_t> occluded(kNearCascades * visibility_bytes(kNearGrid));
  for (std::uint8_t& bits : occluded) bits = random() % 256;
  std::vector<Volume> light;
  std::vector<clpv::Volume> lit;
  for (int c = 0; c < kNearCascades; ++c) {
    light.push_back(random_light(*basis, kNearGrid, random));
    lit.push_back(on_device(session, light.back(), variant.format));
  }
  std::vector<const clpv::Volume*> volumes;
  std::vector<Cascade> cascades;
  for (int c = 0; c < kNearCascades; ++c) {
    volumes.push_back(&lit[c]);
    cascades.push_back({grids[c], &light[c], occluded.data() + c * visibility_bytes(kNearGrid)});
  }
  const NearOptions options{.gather = {.grid = kNearGrid,
                                       .gather = variant.gather,
                                       .gather_offset = 0.25,
                                       .format = variant.format,
                                       .packed = true},
                            .step = variant.step,
                            .rays = variant.rays,
                            .reflects = variant.reflects};

  const Buffer occluded_there = session.upload(occluded, "check: occluded cells");
  const Buffer hidden = variant.gather == Gathering::visible ? occluded_there : Buffer();
  const Surface camera = upload_surface(session, image);
  Buffer irradiance = session.buffer(image.depth.size() * sizeof(cl_float4), "check: irradiance");
  Gatherer gatherer(session, *basis, TransportKind::sweep, options.gather);
  gatherer.gather(camera, {grids, volumes, 1, hidden}, irradiance);
  const SceneBuffers buffers = upload_scene(session, scene);
  clpv::NearField field(session, *basis, scene, buffers, options);
  field.trace(camera, gatherer);
  field.add(camera, gatherer, on_device(session, lights), irradiance);

  const NearResult wanted = near(*basis, options, {scene, materials, lights, cascades}, image,
                                 gather(*basis, TransportKind::sweep, options.gather, cascades, image));
  const std::vector<cl_float4> found = session.read<cl_float4>(irradiance, image.depth.size());
  std::vector<glm::dvec4> expected;
  std::size_t certain = 0;
  for (std::size_t i = 0; i < found.size(); ++i) {
    const bool unsure = wanted.uncertain[i];
    const glm::dvec3 there(found[i].s[0], found[i].s[1], found[i].s[2]);
    certain += unsure ? 0 : 1;
    expected.emplace_back(unsure ? there : wanted.irradiance[i], found[i].s[3]);
  }
  CheckResult result = compare_pixels(found, expected, image.view.width, "near", variant.name);
  result.allowed = tolerance("near", variant.format.storage);
  const double share = static_cast<double>(certain) / static_cast<double>(found.size());
  if (share < kLeastCertain) {
    result.worst = 1;
    result.place = fmt::format("rounding may decide all but {:.0f} % of the pixels", 100 * share);
  }
  return result;
}

}  // namespace

CheckResults check_near(Session& session, const CheckScope& scope) {
  CheckResults results;
  const auto add = [&](const NearVariant& variant) {
    compare_selected(scope, "near", variant.name, results, [&] { return check_one_near(session, variant); });
  };
  add({.name = "quarter", .step = 4});
  add({.name = "reflects", .reflects = true});
  if (!scope.thorough) return results;
  add({.name = "full"});
  add({.name = "half", .step = 2});
  add({.name = "eighth, 2 rays", .step = 8, .rays = 2});
  add({.name = "all cells", .gather = Gathering::all});
  add({.name = "half numbers", .format = {Layout::soa, Storage::float16}});
  return results;
}

}  // namespace clpv::reference
