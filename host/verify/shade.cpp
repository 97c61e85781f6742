// SPDX-License-Identifier: MIT
// Shading: kernels against CPU reference, on random surfaces and random shadow maps of all kinds of light.
#include "pipeline/raster/shade.hpp"

#include <algorithm>
#include <random>

#include "pipeline/raster/view.hpp"
#include "reference/shade.hpp"
#include "support/named_enum.hpp"
#include "verify/check.hpp"
#include "verify/inputs.hpp"

namespace clpv::reference {
namespace {

constexpr unsigned kMapWidth = 24, kMapHeight = 20;
constexpr float kMapReach = 20;  // [m]: range of depths in a map

/// Independent random depths per texel, 1 of 3 empty, so that a wrong filter address causes an error.
ShadowMap random_map(const ClpvView& view, std::mt19937& random) {
  std::uniform_real_distribution<float> uniform(-0.5f, 1);
  ShadowMap map{view, {}};
  for (unsigned texel = 0; texel < kMapWidth * kMapHeight; ++texel) {
    map.depth.push_back(std::max(0.0f, kMapReach * uniform(random)));
  }
  return map;
}

const ClpvLight kSun{{}, CLPV_LIGHT_DIRECTIONAL, {2 / 7.0f, -6 / 7.0f, 3 / 7.0f}, 0, {3, 2, 1}, 0, 0, {}, {}};
/// Cone from full light at acos(0.9) to dark at acos(0.7).
const ClpvLight kSpot{
    {6, 8, -1}, CLPV_LIGHT_SPOT, {-1 / 9.0f, -8 / 9.0f, 4 / 9.0f}, 14, {100, 150, 200}, 5, -3.5f, {}, {}};
const ClpvLight kPoint{{5, 1.5f, 0.3f}, CLPV_LIGHT_POINT, {}, 0, {60, 50, 40}, 0, 0, {}, {}};

/// The sun's map is smaller than the camera's view: some surfaces lie on and beyond its edge.
MappedLight mapped(const ClpvLight& light, std::mt19937& random) {
  const Bounds bounds{{-2, -2, -4}, {8, 8, 6}};
  MappedLight mapped{light, {}};
  for (ClpvView view : shadow_views(light, bounds, kMapWidth)) {
    view.height = kMapHeight;
    mapped.maps.push_back(random_map(view, random));
  }
  return mapped;
}

}  // namespace

CheckResults check_shade(Session& session, const CheckScope& scope) {
  std::mt19937 random(17);
  std::uniform_real_distribution<float> uniform(0, 5);
  const SurfaceImage image = random_surfaces(random);
  const std::size_t pixels = image.depth.size();
  std::vector<cl_float4> irradiance;
  std::vector<glm::dvec3> indirect;
  for (std::size_t pixel = 0; pixel < pixels; ++pixel) {
    irradiance.push_back({{uniform(random), uniform(random), uniform(random), 0}});
    indirect.push_back(vector(irradiance.back().s));
  }
  const Surface camera = upload_surface(session, image);
  const Buffer gathered = session.upload(irradiance, "check: irradiance");
  Buffer shown = session.buffer(pixels * sizeof(cl_float4), "check: image");
  Shader shader(session);
  CheckResults results;
  const auto check = [&](Show show, const std::vector<MappedLight>& lights, const std::string& variant) {
    compare_selected(scope, "shade", variant, results, [&] {
      shader.light(camera, on_device(session, lights));
      shader.show(show, camera, gathered, shown);
      return compare_pixels(session.read<cl_float4>(shown, pixels),
                            shade(show, image, direct_irradiance(lights, image), indirect), image.view.width,
                            "shade", variant);
    });
  };
  const std::vector<MappedLight> lights = {
      mapped(kSun, random), mapped(kSpot, random), mapped(kPoint, random), {kPoint, {}}};
  const char* kinds[] = {"directional", "spot", "point", "no shadow"};
  for (std::size_t i = 0; i < lights.size(); ++i) check(Show::direct, {lights[i]}, kinds[i]);
  for (const Show show : kSurfaceViews) check(show, lights, fmt::format("view {}", name_of(show)));
  return results;
}

}  // namespace clpv::reference
