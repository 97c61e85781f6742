// SPDX-License-Identifier: MIT
// Shading: kernels against the twin, on random surfaces behind random shadow maps of every kind of light.
#include <algorithm>
#include <array>
#include <random>

#include "checks/check.hpp"
#include "checks/check_inputs.hpp"
#include "pipeline/shade.hpp"
#include "reference/shade.hpp"
#include "support/named_enum.hpp"

namespace clpv::reference {
namespace {

constexpr unsigned kMapWidth = 24, kMapHeight = 20;
constexpr float kMapReach = 20;  // [m]: depths in a map

void set(float v[3], const glm::vec3& value) {
  for (int i = 0; i < 3; ++i) v[i] = value[i];
}

/// A view with any `up` that is not along `forward`.
ClpvView map_view(const glm::vec3& eye, const glm::vec3& forward, bool orthographic, float half) {
  const glm::vec3 f = glm::normalize(forward);
  const glm::vec3 r =
      glm::normalize(glm::cross(f, std::abs(f.y) < 0.9f ? glm::vec3(0, 1, 0) : glm::vec3(1, 0, 0)));
  ClpvView view{};
  set(view.eye, eye), set(view.forward, f), set(view.right, r), set(view.up, glm::cross(r, f));
  view.orthographic = orthographic ? 1.0f : 0.0f;
  view.half_width = view.half_height = half;
  view.near_depth = 0.1f, view.far_depth = 100;
  view.width = kMapWidth, view.height = kMapHeight;
  return view;
}

/// Depths without relation from texel to texel, a third of them empty: a tap read from the wrong place shows.
ShadowMap random_map(const ClpvView& view, std::mt19937& random) {
  std::uniform_real_distribution<float> uniform(-0.5f, 1);
  ShadowMap map{view, {}};
  for (unsigned texel = 0; texel < kMapWidth * kMapHeight; ++texel) {
    map.depth.push_back(std::max(0.0f, kMapReach * uniform(random)));
  }
  return map;
}

MappedLight sun(std::mt19937& random) {
  MappedLight light;
  light.light.kind = CLPV_LIGHT_DIRECTIONAL;
  set(light.light.direction, glm::normalize(glm::vec3(0.2f, -1, 0.3f)));
  set(light.light.intensity, {3, 2, 1});
  // Smaller than what the camera sees: some surfaces lie on and beyond its edge.
  light.maps = {random_map(map_view({3, 9, 1}, {0.2f, -1, 0.3f}, true, 6), random)};
  return light;
}

MappedLight spot(std::mt19937& random) {
  MappedLight light;
  light.light.kind = CLPV_LIGHT_SPOT;
  set(light.light.position, {6, 8, -1});
  set(light.light.direction, glm::normalize(glm::vec3(-0.1f, -1, 0.2f)));
  set(light.light.intensity, {100, 150, 200});
  light.light.cone_scale = 5, light.light.cone_offset = -3.5f;  // dark from acos(.7), full from acos(.9)
  light.light.range = 14;
  light.maps = {random_map(map_view({6, 8, -1}, {-0.1f, -1, 0.2f}, false, 1), random)};
  return light;
}

MappedLight point(std::mt19937& random) {
  MappedLight light;
  light.light.kind = CLPV_LIGHT_POINT;
  set(light.light.position, {5, 1.5f, 0.3f});
  set(light.light.intensity, {60, 50, 40});
  constexpr std::array<glm::vec3, 6> axes = {glm::vec3(1, 0, 0),  glm::vec3(-1, 0, 0), glm::vec3(0, 1, 0),
                                             glm::vec3(0, -1, 0), glm::vec3(0, 0, 1),  glm::vec3(0, 0, -1)};
  for (const glm::vec3& axis : axes) {
    light.maps.push_back(random_map(map_view({5, 1.5f, 0.3f}, axis, false, 1), random));
  }
  return light;
}

MappedLight unshadowed(std::mt19937& random) {
  MappedLight light = point(random);
  light.maps.clear();
  return light;
}

ShadowedLight upload(Session& session, const MappedLight& light) {
  ShadowedLight shadowed{light.light, {}, {}};
  for (const ShadowMap& map : light.maps) {
    shadowed.views.push_back(map.view);
    shadowed.depths.push_back(session.upload(map.depth, "check: shadow map"));
  }
  return shadowed;
}

struct Setting {
  SurfaceImage image;
  Surface camera;
  std::vector<glm::dvec3> indirect;
  Buffer irradiance, shown;
};

Setting set_up(Session& session) {
  std::mt19937 random(13);
  std::uniform_real_distribution<float> uniform(0, 5);
  Setting setting;
  setting.image = random_surfaces(random);
  setting.camera = upload_surface(session, setting.image);
  std::vector<cl_float4> irradiance;
  for (std::size_t pixel = 0; pixel < setting.image.depth.size(); ++pixel) {
    irradiance.push_back({{uniform(random), uniform(random), uniform(random), 0}});
    setting.indirect.emplace_back(irradiance.back().s[0], irradiance.back().s[1], irradiance.back().s[2]);
  }
  setting.irradiance = session.upload(irradiance, "check: irradiance");
  setting.shown = session.buffer(irradiance.size() * sizeof(cl_float4), "check: image");
  return setting;
}

CheckResult check_one(Session& session, Shader& shader, Setting& setting, Show show,
                      const std::vector<MappedLight>& lights, const std::string& variant) {
  std::vector<ShadowedLight> shadowed;
  for (const MappedLight& light : lights) shadowed.push_back(upload(session, light));
  shader.light(setting.camera, shadowed);
  shader.show(show, setting.camera, setting.irradiance, setting.shown);
  return compare_pixels(
      session.read<cl_float4>(setting.shown, setting.image.depth.size()),
      shade(show, setting.image, direct_irradiance(lights, setting.image), setting.indirect),
      setting.image.view.width, "shade", variant);
}

}  // namespace

CheckResults check_shade(Session& session) {
  std::mt19937 random(17);
  Setting setting = set_up(session);
  Shader shader(session);
  const std::vector<MappedLight> lights = {sun(random), spot(random), point(random), unshadowed(random)};
  const char* kinds[] = {"directional", "spot", "point", "no shadow"};
  CheckResults results;
  for (std::size_t i = 0; i < lights.size(); ++i) {
    results.push_back(check_one(session, shader, setting, Show::direct, {lights[i]}, kinds[i]));
  }
  for (const Show show : values_of<Show>()) {
    results.push_back(
        check_one(session, shader, setting, show, lights, fmt::format("view {}", name_of(show))));
  }
  return results;
}

}  // namespace clpv::reference
