// SPDX-License-Identifier: MIT
// Shading against closed forms: Lambert's law for every kind of light, views, shadows
// of known outline, surfaces that must not shadow themselves.

#include "pipeline/raster/shade.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numbers>
#include <vector>

#include "reference/shade.hpp"
#include "reference/view.hpp"
#include "support/error.hpp"
#include "support/named_enum.hpp"
#include "tests/support/on_device.hpp"
#include "tests/support/scene_builder.hpp"
#include "verify/inputs.hpp"

namespace clpv::shade_test {

// Scenes of known light for the tests of shading: a floor, suns, bulbs, and shadow maps that are
// ray-cast, texel centre by texel centre.

using reference::MappedLight;
using reference::ShadowMap;
using std::numbers::pi;
using test::test_session;

constexpr unsigned kSide = 96;    // pixels of the camera's image
constexpr double kHalf = 6;       // the camera sees the floor from -kHalf to kHalf [m]
constexpr unsigned kTexels = 64;  // texels along a shadow map's side
constexpr double kMapHalf = 10;   // [m]
constexpr double kTexel = 2 * kMapHalf / kTexels;
constexpr double kFloat = 1e-5;

void set(float v[3], const glm::dvec3& value) {
  for (int i = 0; i < 3; ++i) v[i] = static_cast<float>(value[i]);
}

ClpvView view_of(const glm::dvec3& eye, const glm::dvec3& forward, bool orthographic, double half,
                 unsigned side) {
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

double plane_at(const glm::dvec3& origin, const glm::dvec3& direction, const glm::dvec3& normal,
                double height) {
  const double t = (height - glm::dot(normal, origin)) / glm::dot(normal, direction);
  return std::isfinite(t) && t > 0 ? t : 0;
}

double nearer(double a, double b) {
  return a > 0 && b > 0 ? std::min(a, b) : std::max(a, b);
}

ShadowMap cast(const ClpvView& view, const Geometry& geometry) {
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
SurfaceImage look(const glm::dvec3& forward, const Geometry& geometry,
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

glm::dvec3 point_of(const SurfaceImage& image, std::size_t pixel) {
  return reference::surface_position(image.view, static_cast<double>(pixel % kSide),
                                     static_cast<double>(pixel / kSide), image.depth[pixel]);
}

const glm::dvec3 kUp(0, 1, 0);

Geometry floor_at(double height) {
  return [=](const glm::dvec3& o, const glm::dvec3& d) { return plane_at(o, d, kUp, height); };
}

/// The floor y = 0 from above.
SurfaceImage floor_image() {
  return look(-kUp, floor_at(0), [](const glm::dvec3&) { return kUp; });
}

const glm::vec3 kChannels(1, 2, 3);  // every light's: channels must not be mixed up

MappedLight sun(const glm::dvec3& direction, double irradiance) {
  return {test::directional_light(glm::vec3(direction), static_cast<float>(irradiance) * kChannels),
          {}};
}

MappedLight sun(const glm::dvec3& direction, double irradiance, const Geometry& casting) {
  MappedLight light = sun(direction, irradiance);
  const ClpvView view =
      view_of(-30.0 * glm::normalize(direction), direction, true, kMapHalf, kTexels);
  light.maps = {cast(view, casting)};
  return light;
}

MappedLight bulb(const glm::dvec3& position, double intensity) {
  return {test::point_light(glm::vec3(position), static_cast<float>(intensity) * kChannels), {}};
}

const std::array<glm::dvec3, 6> kDirections = {glm::dvec3(1, 0, 0), glm::dvec3(-1, 0, 0),
                                               glm::dvec3(0, 1, 0), glm::dvec3(0, -1, 0),
                                               glm::dvec3(0, 0, 1), glm::dvec3(0, 0, -1)};

/// E of each pixel, by the kernels: whether a surface shadows itself is a matter of float32.
std::vector<glm::vec4> lit_colours(const SurfaceImage& image,
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
std::vector<double> lit(const SurfaceImage& image, const std::vector<MappedLight>& lights) {
  std::vector<double> e;
  for (const glm::vec4& pixel : lit_colours(image, lights)) e.push_back(pixel.x);
  return e;
}

void expect_lit(const SurfaceImage& image, const MappedLight& light,
                const std::function<double(const glm::dvec3&)>& expected, double scale) {
  const std::vector<glm::vec4> e = lit_colours(image, {light});
  for (std::size_t pixel = 0; pixel < e.size(); ++pixel) {
    const double wanted = expected(point_of(image, pixel));
    for (int c = 0; c < 3; ++c)
      ASSERT_NEAR(e[pixel][c], wanted * double{kChannels[c]}, 3 * kFloat * scale)
          << "pixel " << pixel;
  }
}

TEST(Shade, PointLightFollowsCosineAndSquaredDistance) {
  const glm::dvec3 at(1, 2, -0.5);
  expect_lit(
      floor_image(), bulb(at, 40),
      [&](const glm::dvec3& p) {
        const double r = glm::length(at - p);
        return 40 * (at.y / r) / (r * r);
      },
      10);
}

TEST(Shade, NothingIsLitBeyondTheRange) {
  MappedLight light = bulb({0, 2, 0}, 40);
  light.light.range = 3;
  const SurfaceImage image = floor_image();
  const std::vector<double> e = lit(image, {light}), unlimited = lit(image, {bulb({0, 2, 0}, 40)});
  for (std::size_t pixel = 0; pixel < e.size(); ++pixel) {
    const double r = glm::length(point_of(image, pixel) - glm::dvec3(0, 2, 0));
    ASSERT_EQ(e[pixel], r <= 3 ? unlimited[pixel] : 0.0) << "at " << r << " m";
  }
}

TEST(Shade, AnUnknownKindOfLightIsDarkAndTheReferenceRejectsIt) {
  MappedLight light = bulb({0, 2, 0}, 40);
  light.light.kind = 3;
  EXPECT_THAT(lit(floor_image(), {light}), ::testing::Each(0.0));
  EXPECT_THROW(reference::direct_irradiance({light}, floor_image()), Error);
}

TEST(Shade, LightFromBehindIsDark) {
  expect_lit(
      floor_image(), sun({0.2, 1, 0}, 7), [](const glm::dvec3&) { return 0; }, 7);
  expect_lit(
      floor_image(), bulb({0, -1, 0}, 7), [](const glm::dvec3&) { return 0; }, 7);
}

TEST(Shade, LightInTheSurfaceStaysFinite) {
  for (const double e : lit(floor_image(), {bulb(point_of(floor_image(), 4000), 1000)}))
    ASSERT_TRUE(std::isfinite(e));
}

TEST(Shade, EachViewShowsItsShare) {
  SurfaceImage image = floor_image();
  std::vector<glm::dvec3> indirect;
  for (std::size_t pixel = 0; pixel < image.depth.size(); ++pixel) {
    const auto f = static_cast<float>(pixel % 7);
    image.colour[pixel] = glm::vec4(0.1f * f, 0.5f, 0.9f, 1);
    image.emissive.emplace_back(f, 0.25f, 0, 0);
    indirect.emplace_back(1 + f, 2, 3);
    if (pixel % 5 == 0) image.depth[pixel] = 0;
  }
  const std::vector<glm::dvec3> direct_light =
      reference::direct_irradiance({sun({0, -1, 0}, 7)}, image);
  std::vector<std::vector<glm::dvec4>> shown;
  for (const Show view : kSurfaceViews)
    shown.push_back(reference::shade(view, image, direct_light, indirect));
  for (std::size_t pixel = 0; pixel < image.depth.size(); ++pixel) {
    const bool background = image.depth[pixel] <= 0;
    const glm::dvec3 albedo(image.colour[pixel]),
        bounced = albedo / pi * indirect[pixel],
        direct = albedo / pi * glm::dvec3(7, 14, 21) + glm::dvec3(image.emissive[pixel]);
    const glm::dvec3 expected[] = {direct + bounced,
                                   direct,
                                   bounced,
                                   indirect[pixel],
                                   albedo,
                                   {0, 1, 0},
                                   glm::dvec3(image.depth[pixel])};
    for (std::size_t s = 0; s < shown.size(); ++s) {
      const glm::dvec4 wanted = background ? glm::dvec4(0) : glm::dvec4(expected[s], 1);
      ASSERT_LE(glm::length(shown[s][pixel] - wanted), background ? 0 : 1e-5)
          << names_of<Show>()[s] << ", pixel " << pixel;
    }
  }
}

/// A roof 2 m above the floor, over all x < 0.
double roof(const glm::dvec3& o, const glm::dvec3& d) {
  const double t = plane_at(o, d, kUp, 2);
  return t > 0 && (o + t * d).x < 0 ? t : 0;
}

TEST(Shadow, ShadowLiesBelowTheRoof) {
  for (const double slant : {0.0, 0.6, -1.1}) {
    const SurfaceImage image = floor_image();
    const glm::dvec3 direction = glm::normalize(glm::dvec3(slant, -1, 0.1));
    const Geometry casting = [](const glm::dvec3& o, const glm::dvec3& d) {
      return nearer(plane_at(o, d, kUp, 0), roof(o, d));
    };
    const std::vector<double> e = lit(image, {sun(direction, 7, casting)});
    // Light travels 2 m down on its way past the edge Two texels of filter on either side, as the
    // floor is cut by the map's slanted texels.
    const double full = -7 * direction.y, edge = 2 * slant;
    const double penumbra = 2 * kTexel / -direction.y;
    double narrowest = 1e9, widest = -1e9;
    for (std::size_t pixel = 0; pixel < e.size(); ++pixel) {
      const double x = point_of(image, pixel).x;
      if (x < edge - penumbra) {
        ASSERT_EQ(e[pixel], 0.0) << "x " << x << " slant " << slant;
      }
      if (x > edge + penumbra) {
        ASSERT_NEAR(e[pixel], full, 7 * kFloat) << "x " << x << " slant " << slant;
      }
      if (e[pixel] > 0.45 * full && e[pixel] < 0.55 * full) {
        narrowest = std::min(narrowest, x), widest = std::max(widest, x);
      }
    }
    EXPECT_GT(narrowest, edge - kTexel / -direction.y) << "half the light arrives at the edge";
    EXPECT_LT(widest, edge + kTexel / -direction.y);
  }
}

TEST(Shadow, TiltedPlanesDoNotShadowThemselves) {
  // A plane that the light grazes at up to 89 degrees, seen face on, the light's texels turned
  // against the camera's.
  for (const double degrees : {0.0, 20.0, 45.0, 70.0, 85.0, 89.0}) {
    for (const double azimuth : {0.0, 0.4, 2.0}) {
      const double angle = degrees / 180 * pi;
      const glm::dvec3 direction(std::sin(angle) * std::cos(azimuth), -std::cos(angle),
                                 std::sin(angle) * std::sin(azimuth));
      expect_lit(
          floor_image(), sun(direction, 7, floor_at(0)),
          [&](const glm::dvec3&) { return 7 * std::cos(angle); }, 7);
    }
  }
}

TEST(Shadow, ShadowsKeepTouchingWhatCastsThem) {
  // A wall x = 0 of 3 m on the floor; the light comes over it at 45 degrees. Light may leak at its
  // foot by half the filter and by the part of the wall below the lift.
  const double foot =
      (2 * std::sqrt(2.0) + CLPV_SHADOW_LIFT_FLAT + CLPV_SHADOW_LIFT_SLOPED * std::sqrt(0.5)) *
      kTexel;
  const Geometry casting = [](const glm::dvec3& o, const glm::dvec3& d) {
    const double t = plane_at(o, d, {1, 0, 0}, 0);
    const double y = (o + t * d).y;
    return nearer(plane_at(o, d, kUp, 0), t > 0 && y > 0 && y < 3 ? t : 0);
  };
  const SurfaceImage image = floor_image();
  const std::vector<double> e = lit(image, {sun({1, -1, 0}, 7, casting)});
  for (std::size_t pixel = 0; pixel < e.size(); ++pixel) {
    const double x = point_of(image, pixel).x;
    if (x > foot && x < 3 - 3 * kTexel) {
      ASSERT_EQ(e[pixel], 0.0) << "light under the wall at x " << x;
    }
    if (x < -3 * kTexel || x > 3 + 3 * kTexel) {
      ASSERT_NEAR(e[pixel], 7 * std::sqrt(0.5), 7 * kFloat) << "x " << x;
    }
  }
}

TEST(Shadow, GrazingLightDoesNotPassUnderWhatIsFarTowardsIt) {
  // A roof half a texel above a floor of a curved mesh, 6 texels away along the light.
  SurfaceImage image = floor_image();
  for (glm::vec4& normal : image.normal)
    normal = stored_normal(glm::normalize(glm::dvec3(-0.1, 1, 0)), kUp);
  const double angle = 85.0 / 180 * pi, height = 0.5 * kTexel;
  const glm::dvec3 direction(std::sin(angle), -std::cos(angle), 0);
  const Geometry casting = [&](const glm::dvec3& o, const glm::dvec3& d) {
    const double t = plane_at(o, d, kUp, height);
    return nearer(plane_at(o, d, kUp, 0), (o + t * d).x < 0 ? t : 0);
  };
  const std::vector<double> e = lit(image, {sun(direction, 7, casting)});
  const double beyond = (CLPV_SHADOW_TAPS / std::cos(angle) + 1) * kTexel;
  for (std::size_t pixel = 0; pixel < e.size(); ++pixel) {
    const double x = point_of(image, pixel).x;
    if (x < -beyond) ASSERT_EQ(e[pixel], 0.0) << "light under the roof at x " << x;
    if (x > beyond) ASSERT_GT(e[pixel], 0.0) << "x " << x;
  }
  // Light along the mesh passes any roof within the filter's width of its plane.
  EXPECT_THAT(lit(image, {sun({1, -0.004, 0}, 7, casting)}), ::testing::Each(0.0));
}

// A floor that the light grazes at up to 87 degrees; and a room whose walls are oblique to the six
// views.
TEST(Shadow, SixViewsOfAPointLightShowNoSeamsAndDoNotShadowTheirReceiver) {
  const auto room = [](const glm::dvec3& o, const glm::dvec3& d) {
    double t = 0;
    for (const glm::dvec3& n : kDirections) {
      if (glm::dot(n, d) > 0) t = nearer(t, plane_at(o, d, n, n.y < 0 ? 0 : 7));
    }
    return t;
  };
  struct Case {
    glm::dvec3 at;
    Geometry casting;
  };
  for (const auto& [at, casting] :
       {Case{{-4, 0.6, 1}, floor_at(0)}, Case{{0.7, 2.5, -1.1}, room}}) {
    MappedLight light = bulb(at, 40);
    for (const glm::dvec3& direction : kDirections)
      light.maps.push_back(cast(view_of(at, direction, false, 1, kTexels), casting));
    const SurfaceImage image = floor_image();
    const std::vector<double> e = lit(image, {light}), unshadowed = lit(image, {bulb(at, 40)});
    for (std::size_t pixel = 0; pixel < e.size(); ++pixel)
      ASSERT_NEAR(e[pixel], unshadowed[pixel], 1e-6 * unshadowed[pixel]) << "pixel " << pixel;
  }
}

TEST(Shade, RejectsMapsThatDoNotFit) {
  const SurfaceImage image = floor_image();
  const Surface camera = upload_surface(test_session(), image);
  Shader shader(test_session());
  ShadowedLight shadowed = verify::on_device(test_session(), {sun({0, -1, 0}, 7, floor_at(0))})[0];
  shadowed.views[0].width = 3;
  EXPECT_THROW(shader.light(camera, {shadowed}), Error);
  shadowed.views[0].width = kTexels;
  shadowed.depths.clear();
  EXPECT_THROW(shader.light(camera, {shadowed}), Error);
}

}  // namespace clpv::shade_test
