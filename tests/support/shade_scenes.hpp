// SPDX-License-Identifier: MIT
// Scenes of known light for the tests of shading: a floor, suns, bulbs, and shadow maps that are
// ray-cast, texel centre by texel centre.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numbers>
#include <vector>

#include "pipeline/raster/shade.hpp"
#include "reference/shade.hpp"
#include "reference/view.hpp"
#include "tests/support/on_device.hpp"
#include "tests/support/scene_builder.hpp"
#include "verify/inputs.hpp"

namespace clpv {
namespace shade_scenes {

using reference::MappedLight;
using reference::ShadowMap;
using std::numbers::pi;
using test::test_session;

inline constexpr unsigned kSide = 96;    // pixels of the camera's image
inline constexpr double kHalf = 6;       // the camera sees the floor from -kHalf to kHalf [m]
inline constexpr unsigned kTexels = 64;  // texels along a shadow map's side
inline constexpr double kMapHalf = 10;   // [m]
inline constexpr double kTexel = 2 * kMapHalf / kTexels;
inline constexpr double kFloat = 1e-5;

inline void set(float v[3], const glm::dvec3& value) {
  for (int i = 0; i < 3; ++i) v[i] = static_cast<float>(value[i]);
}

inline ClpvView view_of(const glm::dvec3& eye, const glm::dvec3& forward, bool orthographic,
                        double half, unsigned side) {
  const glm::dvec3 f = glm::normalize(forward);
  const glm::dvec3 r = glm::normalize(
      glm::cross(f, std::abs(f.z) < 0.9 ? glm::dvec3(0, 0, -1) : glm::dvec3(0, 1, 0)));
  ClpvView view{};
  set(view.eye, eye), set(view.forward, f), set(view.right, r), set(view.up, glm::cross(r, f));
  view.orthographic = orthographic ? 1.0f : 0.0f;
  view.half_width = view.half_height = static_cast<float>(half);
  view.near_depth = 0.01f, view.far_depth = 1000;
  view.width = view.height = side;
  return view;
}

/// Parameter t of the first hit of the ray `origin` + t `direction`; 0 without a hit at t > 0.
using Geometry = std::function<double(const glm::dvec3& origin, const glm::dvec3& direction)>;

inline double plane_at(const glm::dvec3& origin, const glm::dvec3& direction,
                       const glm::dvec3& normal, double height) {
  const double t = (height - glm::dot(normal, origin)) / glm::dot(normal, direction);
  return std::isfinite(t) && t > 0 ? t : 0;
}

inline double nearer(double a, double b) {
  return a > 0 && b > 0 ? std::min(a, b) : std::max(a, b);
}

inline ShadowMap cast(const ClpvView& view, const Geometry& geometry) {
  ShadowMap map{view, {}};
  for (unsigned y = 0; y < view.height; ++y) {
    for (unsigned x = 0; x < view.width; ++x) {
      const glm::dvec3 at0 = reference::surface_position(view, x, y, 0);
      // Advances depth by 1.
      const glm::dvec3 ray = reference::surface_position(view, x, y, 1) - at0;
      map.depth.push_back(static_cast<float>(geometry(at0, ray)));
    }
  }
  return map;
}

/// G-buffer of an orthographic camera along `forward`, for a geometry whose normal is known; albedo
/// pi, so that the radiance it shows is E.
inline SurfaceImage look(const glm::dvec3& forward, const Geometry& geometry,
                         const std::function<glm::dvec3(const glm::dvec3&)>& normal) {
  SurfaceImage image;
  image.view = view_of(-20.0 * glm::normalize(forward), forward, true, kHalf, kSide);
  const ShadowMap seen = cast(image.view, geometry);
  image.depth = seen.depth;
  for (unsigned pixel = 0; pixel < kSide * kSide; ++pixel) {
    const glm::dvec3 p =
        reference::surface_position(image.view, pixel % kSide, pixel / kSide, image.depth[pixel]);
    image.normal.emplace_back(image.depth[pixel] > 0 ? glm::vec3(normal(p)) : glm::vec3(0), 0.0f);
    image.colour.emplace_back(glm::vec3(static_cast<float>(pi)), 1.0f);
  }
  return image;
}

inline glm::dvec3 point_of(const SurfaceImage& image, std::size_t pixel) {
  return reference::surface_position(image.view, static_cast<double>(pixel % kSide),
                                     static_cast<double>(pixel / kSide), image.depth[pixel]);
}

inline const glm::dvec3 kUp(0, 1, 0);

inline Geometry floor_at(double height) {
  return [=](const glm::dvec3& o, const glm::dvec3& d) { return plane_at(o, d, kUp, height); };
}

/// The floor y = 0 from above.
inline SurfaceImage floor_image() {
  return look(-kUp, floor_at(0), [](const glm::dvec3&) { return kUp; });
}

inline const glm::vec3 kChannels(1, 2, 3);  // every light's: channels must not be mixed up

inline MappedLight sun(const glm::dvec3& direction, double irradiance) {
  return {test::directional_light(glm::vec3(direction), static_cast<float>(irradiance) * kChannels),
          {}};
}

inline MappedLight sun(const glm::dvec3& direction, double irradiance, const Geometry& casting) {
  MappedLight light = sun(direction, irradiance);
  const ClpvView view =
      view_of(-30.0 * glm::normalize(direction), direction, true, kMapHalf, kTexels);
  light.maps = {cast(view, casting)};
  return light;
}

inline MappedLight bulb(const glm::dvec3& position, double intensity) {
  return {test::point_light(glm::vec3(position), static_cast<float>(intensity) * kChannels), {}};
}

inline const std::array<glm::dvec3, 6> kDirections = {glm::dvec3(1, 0, 0), glm::dvec3(-1, 0, 0),
                                                      glm::dvec3(0, 1, 0), glm::dvec3(0, -1, 0),
                                                      glm::dvec3(0, 0, 1), glm::dvec3(0, 0, -1)};

/// E of each pixel, by the kernels: whether a surface shadows itself is a matter of float32.
inline std::vector<glm::vec4> lit_colours(const SurfaceImage& image,
                                          const std::vector<MappedLight>& lights) {
  const std::size_t pixels = image.depth.size();
  const Buffer irradiance =
      test_session().upload(std::vector<cl_float4>(pixels), "test: irradiance");
  Buffer shown = test_session().buffer(pixels * sizeof(glm::vec4), "test: image");
  const Surface camera = upload_surface(test_session(), image);
  Shader shader(test_session());
  shader.light(camera, verify::on_device(test_session(), lights));
  shader.show(Show::direct, camera, irradiance, shown);
  return test_session().read<glm::vec4>(shown, pixels);
}

/// E of the first channel.
inline std::vector<double> lit(const SurfaceImage& image, const std::vector<MappedLight>& lights) {
  std::vector<double> e;
  for (const glm::vec4& pixel : lit_colours(image, lights)) e.push_back(pixel.x);
  return e;
}

inline void expect_lit(const SurfaceImage& image, const MappedLight& light,
                       const std::function<double(const glm::dvec3&)>& expected, double scale) {
  const std::vector<glm::vec4> e = lit_colours(image, {light});
  for (std::size_t pixel = 0; pixel < e.size(); ++pixel) {
    const double wanted = expected(point_of(image, pixel));
    for (int c = 0; c < 3; ++c)
      ASSERT_NEAR(e[pixel][c], wanted * double{kChannels[c]}, 3 * kFloat * scale)
          << "pixel " << pixel;
  }
}

}  // namespace shade_scenes
}  // namespace clpv
