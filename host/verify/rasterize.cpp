// SPDX-License-Identifier: MIT
// Rasteriser against CPU reference: random and degenerate triangles, all kinds of views.
#include "pipeline/raster/rasterize.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>

#include "pipeline/raster/view.hpp"
#include "reference/rasterize.hpp"
#include "scene/scene.hpp"
#include "verify/check.hpp"
#include "verify/inputs.hpp"
#include "verify/tolerances.hpp"

namespace clpv::verify {
namespace {

constexpr int kRasterWidth = 41, kRasterHeight = 27;  // no multiples of a tile
constexpr int kLightSize = 37;

class SceneMaker {
 public:
  explicit SceneMaker(unsigned seed) : random_(seed) {}

  /// Triangles of all materials, from specks to some that extend past the eye.
  SceneData soup() {
    SceneData scene = with_materials();
    for (int i = 0; i < 120; ++i) {
      const glm::vec3 middle = 4.0f * direction() + glm::vec3(0, 0, -4);
      const float size = std::exp(4 * uniform() - 2);  // 0.02 to 7 m
      add(scene,
          {middle + size * direction(), middle + size * direction(), middle + size * direction()});
    }
    return scene;
  }

  /// A curved sheet of triangles with shared vertices, and below it a floor that contains the eye.
  SceneData sheet() {
    SceneData scene = with_materials();
    constexpr unsigned kCells = 8;
    for (unsigned j = 0; j <= kCells; ++j) {
      for (unsigned i = 0; i <= kCells; ++i) {
        const glm::vec2 at = glm::vec2(i, j) + 0.3f * glm::vec2(uniform(), uniform());
        vertex(scene, {at.x - 4, at.y - 3, -4 + 0.5f * std::sin(at.x) * std::sin(at.y)}, {0, 0, 1});
      }
    }
    for (unsigned j = 0; j < kCells; ++j) {
      for (unsigned i = 0; i < kCells; ++i) {
        const unsigned a = j * (kCells + 1) + i, c = a + kCells + 2;
        scene.triangles.push_back({{a, a + 1, c}, (i + j) % 4});
        scene.triangles.push_back({{a, c, c - 1}, (i + j) % 4});
      }
    }
    add(scene, {glm::vec3(-9, -0.9f, 7), glm::vec3(9, -1, 6), glm::vec3(1, -1.1f, -30)});
    return scene;
  }

  /// Vertices on pixel centres and borders of an orthographic view of 1/8 m per pixel, surfaces at
  /// equal depth, a triangle beyond the guard band on all sides, and triangles without area.
  SceneData lattice() {
    SceneData scene = with_materials();
    for (int i = 0; i < 60; ++i) {
      const auto at = [&] { return glm::vec3(step(), step(), -2 - static_cast<float>(i % 3)); };
      add(scene, {at(), at(), at()});
    }
    add(scene, {glm::vec3(-4e7f, -4e7f, -3), glm::vec3(4e7f, 0, -3), glm::vec3(-4e7f, 4e7f, -3)});
    add(scene, {glm::vec3(0, 0, -1), glm::vec3(1, 1, -1), glm::vec3(2, 2, -1)});
    add(scene, {glm::vec3(1, 0, -1), glm::vec3(1, 0, -1), glm::vec3(1, 0, -1)});
    return scene;
  }

 private:
  float uniform() { return std::uniform_real_distribution<float>(-1, 1)(random_); }
  glm::vec3 direction() { return {uniform(), uniform(), uniform()}; }
  float step() { return std::round(32 * uniform()) / 16; }

  unsigned vertex(SceneData& scene, const glm::vec3& p, const glm::vec3& normal) {
    const glm::vec3 n = glm::normalize(normal + 0.3f * direction());
    Vertex v{{p.x, p.y, p.z}, {n.x, n.y, n.z}, {3 * uniform(), 3 * uniform()}, {}};
    for (int c = 0; c < 4; ++c) v.colour[c] = 0.9f + 0.1f * uniform();
    scene.vertices.push_back(v);
    return scene.vertices.size() - 1;
  }

  void add(SceneData& scene, const std::array<glm::vec3, 3>& p) {
    const glm::vec3 across = glm::cross(p[1] - p[0], p[2] - p[0]);
    const glm::vec3 normal = glm::length(across) > 0 ? glm::normalize(across) : glm::vec3(0, 0, 1);
    Triangle triangle{};
    for (std::size_t i = 0; i < 3; ++i) triangle.vertex[i] = vertex(scene, p[i], normal);
    triangle.material = scene.triangles.size() % scene.materials.size();
    scene.triangles.push_back(triangle);
  }

  /// Plain, textured, double-sided, masked and emissive materials; textures of odd sizes and every
  /// wrap mode.
  SceneData with_materials() {
    SceneData scene;
    for (std::uint32_t i = 0; i < 3; ++i) {
      Texture texture{.width = 5 + 4 * i,
                      .height = 8 - 2 * i,
                      .wrap_u = i,
                      .wrap_v = (i + 1) % 3,
                      .rgba = {},
                      .name = {}};
      for (std::uint32_t k = 0; k < texture.width * texture.height; ++k) {
        for (int c = 0; c < 3; ++c)
          texture.rgba.push_back(static_cast<std::uint8_t>(random_() % 256));
        texture.rgba.push_back(random_() % 4 == 0 ? 0 : 255);
      }
      scene.textures.push_back(texture);
    }
    for (unsigned i = 0; i < 6; ++i) {
      ClpvMaterial m{{0.9f, 0.6f, 0.3f, 1}, {0, 0, 0}, 0.5f, i % 4 == 0 ? CLPV_NO_TEXTURE : i % 3,
                     CLPV_NO_TEXTURE,       0,         0};
      if (i % 2 == 1) m.flags |= CLPV_MATERIAL_DOUBLE_SIDED;
      if (i == 2 || i == 3) m.flags |= CLPV_MATERIAL_MASKED;
      if (i == 5) m.emissive[1] = 2, m.emissive_texture = 1;
      scene.materials.push_back(m);
    }
    return scene;
  }

  std::mt19937 random_;
};

/// Share of an error of geometric normals, which are right within 3e-3 rad: they have 24 bits, and
/// none where both normals are nearly equal.
constexpr double kGeometricShare = 0.005;

double largest(const std::vector<glm::vec4>& field) {
  float maximum = 0;
  for (const glm::vec4& v : field)
    maximum = std::max({maximum, std::abs(v.x), std::abs(v.y), std::abs(v.z)});
  return maximum > 0 ? maximum : 1.0;
}

/// Returns the largest difference of a pixel's three numbers, relative to the field's largest
/// value; 0 without a field.
double relative_difference(const std::vector<glm::vec4>& device,
                           const std::vector<glm::vec4>& expected, std::size_t at) {
  if (device.empty() || expected.empty()) return 0;
  const glm::dvec3 off = glm::abs(glm::dvec3(device[at]) - glm::dvec3(expected[at]));
  return glm::any(glm::isnan(off)) ? NAN : std::max({off.x, off.y, off.z}) / largest(expected);
}

/// Compares a device's surface with the CPU reference pixel by pixel. Checks values where the
/// reference is certain, and the share of the other pixels that differ.
void append(CheckResults& results, const SurfaceImage& device,
            const reference::RasterizedImage& expected, const std::string& variant) {
  Deviation values{0, tolerance("rasterize")};
  const SurfaceImage& image = expected.image;
  const double deepest = std::max(1.0f, std::ranges::max(image.depth));
  std::size_t differing = 0;
  for (std::size_t at = 0; at < expected.uncertain.size(); ++at) {
    Deviation pixel{0, values.allowed};
    const double errors[] = {std::abs(double{device.depth[at]} - image.depth[at]) / deepest,
                             relative_difference(device.normal, image.normal, at),
                             kGeometricShare * glm::distance(geometric_normal(device.normal[at]),
                                                             geometric_normal(image.normal[at])),
                             relative_difference(device.colour, image.colour, at),
                             relative_difference(device.emissive, image.emissive, at)};
    for (const double error : errors) {
      (expected.uncertain[at] ? pixel : values).take(error, [&] {
        return fmt::format(
            "pixel {},{}: depth {:.7g}, expected {:.7g}; errors of depth, both normals, colour and "
            "emission {:.1e}",
            at % image.view.width, at / image.view.width, device.depth[at], image.depth[at],
            fmt::join(errors, ", "));
      });
    }
    if (!pixel.passed()) ++differing;
  }
  const double pixels = expected.uncertain.size();
  results.push_back(result_of("rasterize", variant, values));
  results.push_back(result_of("rasterize", variant + ", edges",
                              {differing / pixels, tolerance("rasterize-edges"),
                               fmt::format("{} of {} pixels, {} of them uncertain", differing,
                                           pixels, std::ranges::count(expected.uncertain, true))}));
}

CheckResults compare_camera(Session& session, const SceneData& scene, const std::string& name) {
  SceneCamera camera;
  camera.near_depth = 0.3f;
  const ClpvView view = camera_view(camera, kRasterWidth, kRasterHeight);
  Rasterizer rasterizer(session, upload_scene(session, scene));
  Surface surface = make_surface(session, view, RsmFormat::float32, true);
  rasterizer.rasterize_camera(surface);
  const reference::RasterizedImage expected = reference::rasterize_camera(scene, view);
  expect_surface(session, surface, expected.image, expected.uncertain, tolerance("rasterize"));
  CheckResults results;
  append(results, read_surface(session, surface), expected, "camera/" + name);
  return results;
}

CheckResults compare_light(Session& session, const SceneData& scene, const ClpvLight& light,
                           const ClpvView& view, const std::string& name) {
  Rasterizer rasterizer(session, upload_scene(session, scene));
  Surface surface = make_surface(session, view, RsmFormat::float32, false);
  rasterizer.rasterize_rsm(light, surface);
  const SurfaceImage device = read_surface(session, surface);
  const reference::RasterizedImage expected = reference::rasterize_rsm(scene, light, view);
  expect_surface(session, surface, expected.image, expected.uncertain, tolerance("rasterize"));
  CheckResults results;
  append(results, device, expected, "rsm/" + name);
  Buffer depth = session.buffer(device.depth.size() * sizeof(float), "check: shadow map");
  rasterizer.rasterize_shadow(view, depth);
  expect_depths(session, depth, expected.image.depth, expected.uncertain, tolerance("rasterize"));
  SurfaceImage shadow = expected.image;
  shadow.depth = session.read<float>(depth, device.depth.size());
  append(results, shadow, expected, "shadow/" + name);
  return results;
}

ClpvLight sun() {
  ClpvLight light{};
  light.kind = CLPV_LIGHT_DIRECTIONAL, light.direction[2] = -1;
  for (int c = 0; c < 3; ++c) light.intensity[c] = 1.0f + static_cast<float>(c);
  return light;
}

/// Views along the z axis, 1/8 m per pixel: the lattice's vertices fall on pixel centres and
/// borders.
ClpvView lattice_view() {
  ClpvView view = camera_view(SceneCamera{}, 2 * kLightSize - 10, kLightSize - 5);
  view.orthographic = 1;
  view.half_width = static_cast<float>(view.width) / 16;
  view.half_height = static_cast<float>(view.height) / 16;
  view.near_depth = 2.5f, view.far_depth = 3.5f;  // between the lattice's layers
  return view;
}

ClpvLight spot() {
  ClpvLight light{};
  light.kind = CLPV_LIGHT_SPOT, light.position[0] = 1, light.position[1] = 3;
  light.direction[1] = -0.6f, light.direction[2] = -0.8f;
  light.range = 9, light.cone_scale = 4, light.cone_offset = -2.8f;
  for (int c = 0; c < 3; ++c) light.intensity[c] = 10.0f * static_cast<float>(c + 1);
  return light;
}

ClpvLight narrow_spot() {
  ClpvLight light = spot();
  set_cone(light, 0.02, 0.04);
  return light;
}

}  // namespace

Cases rasterize_cases(const CheckScope&) {
  Cases cases;
  SceneMaker maker(3);
  const SceneData soup = maker.soup(), sheet = maker.sheet(), lattice = maker.lattice();
  const auto add_camera = [&](const std::string& name, const SceneData& scene) {
    cases.push_back({Stage::rasterize, "camera/" + name,
                     [=](Session& session) { return compare_camera(session, scene, name); }});
  };
  const auto add_light = [&](const std::string& name, const SceneData& scene,
                             const ClpvLight& light, const ClpvView& view) {
    cases.push_back({Stage::rasterize, "light/" + name, [=](Session& session) {
                       return compare_light(session, scene, light, view, name);
                     }});
  };
  add_camera("soup", soup);
  add_camera("sheet", sheet);
  const Bounds bounds{glm::vec3(-12, -12, -12), glm::vec3(12, 12, 8)};
  const ClpvGrid cascade{{-2, -2, -6}, 0.5f, 8, {}};
  add_light("lattice", lattice, sun(), lattice_view());
  add_light("directional", soup, sun(), directional_rsm_view(sun(), cascade, bounds, kLightSize));
  add_light("spot", sheet, spot(), spot_view(spot(), kLightSize, bounds));
  add_light("narrow spot", sheet, narrow_spot(), spot_view(narrow_spot(), kLightSize, bounds));
  return cases;
}

}  // namespace clpv::verify
