// SPDX-License-Identifier: MIT
// Reflected light against closed forms, by the CPU reference.
#include "pipeline/sweep/bounce.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <numbers>
#include <vector>

#include "basis/bounce.hpp"
#include "basis/sweep.hpp"
#include "pipeline/frame/cascade.hpp"
#include "pipeline/frame/frame.hpp"
#include "pipeline/sweep/sweep.hpp"
#include "reference/blockers.hpp"
#include "reference/bounce.hpp"
#include "scene/load.hpp"
#include "tests/support/on_device.hpp"
#include "tests/support/scene_builder.hpp"
#include "verify/check.hpp"

namespace clpv::bounce_test {
using namespace test;

constexpr double kExact = 1e-12;

Transport swept() {
  return make_transport(TransportKind::sweep, *make_basis("bins24"), {}, Blocking::areas);
}

TEST(Bounce, FacesEmitAllReflectedFlux) {
  const Matrix light = reflected_intensity(*make_basis("bins24"));
  for (int side = 0; side < kCellFaces; ++side) {
    double flux = 0, along = 0;
    for (int b = 0; b < kSweepBins; ++b) {
      const SweepBin bin = sweep_bins(1)[static_cast<std::size_t>(b)];
      const double cosine = (side % 2 == 0 ? 1 : -1) * bin.directions[0].w[side / 2];
      EXPECT_GE(light(b, side), -kExact);
      EXPECT_TRUE(cosine > 0 || light(b, side) < 0.01) << b << ' ' << side;
      flux += bin.solid_angle * light(b, side);
      along += bin.solid_angle * light(b, side) * cosine;
    }
    EXPECT_NEAR(flux, 1, kExact);
    EXPECT_NEAR(along, 2.0 / 3, 0.03) << "a cosine's";
  }
}

// Under the same light from everywhere a white wall sends back the light that falls on it.
TEST(Bounce, AWhiteFaceReturnsEvenLight) {
  const Matrix flux = incident_flux(), light = reflected_intensity(*make_basis("bins24"));
  const std::vector<double> even(kSweepBins, 1.0);
  const std::vector<double> arriving = flux * std::span<const double>(even);
  for (int side = 0; side < kCellFaces; ++side) {
    EXPECT_NEAR(arriving[static_cast<std::size_t>(side)], std::numbers::pi, kExact);
    for (int b = 0; b < kSweepBins; ++b) {
      const double cosine = (side % 2 == 0 ? 1 : -1) *
                            sweep_bins(1)[static_cast<std::size_t>(b)].directions[0].w[side / 2];
      EXPECT_NEAR(light(b, side) * arriving[static_cast<std::size_t>(side)], std::max(0.0, cosine),
                  0.04);  // the bins' own sum for even light is 1.046 pi
    }
  }
}

constexpr int kGrid = 12, kFirst = 2, kLast = 9;  // cells inside the room

bool inside(const glm::ivec3& p) {
  return glm::all(glm::greaterThanEqual(p, glm::ivec3(kFirst))) &&
         glm::all(glm::lessThanEqual(p, glm::ivec3(kLast)));
}

/// A closed box with one albedo; its walls lie in the middle of the blocking corners next to the
/// inner cells.
SceneData room_scene(float albedo, const ClpvGrid& grid) {
  SceneData scene;
  const unsigned material = add_material(scene, glm::vec3(albedo));
  const glm::vec3 origin(grid.origin[0], grid.origin[1], grid.origin[2]);
  const float low = kFirst - 0.49f, edge = kLast + 1.49f - low;
  add_box(scene, origin + low, edge, material);
  return scene;
}

/// The room's walls, as stages find them; and light that leaves each of them by 1 W a face.
struct Room {
  ClpvGrid grid = cascade_grids(glm::vec3(0.5f), 1, kGrid, kGrid).front();
  SceneData scene;
  reference::Volume light{kGrid, kSweepBins}, blockers, white, reflectors;

  explicit Room(float albedo) : scene(room_scene(albedo, grid)) {
    blockers = reference::voxelize_blockers(scene, grid).lower;
    reflectors = reference::voxelize_reflectors(scene, grid).areas;
    white = reference::voxelize_reflectors(scene, grid, true).areas;
    const Matrix leaving = reflected_intensity(*make_basis("bins24"));
    reference::for_each_cell(kGrid, [&](const glm::ivec3& p) {
      if (!inside(p)) return;
      for (int side = 0; side < kCellFaces; ++side) {
        if (p[side / 2] != (side % 2 == 0 ? kFirst : kLast)) continue;
        for (int channel = 0; channel < 3; ++channel) {
          for (int b = 0; b < kSweepBins; ++b)
            light.at(channel, b, p.x, p.y, p.z) += leaving(b, side);
        }
      }
    });
  }

  /// All light inside.
  double lit(Bounces bounces, int parts = 1) const {
    const reference::SweptCascade cascade{grid, &light, &blockers, parts};
    const auto bins = make_basis("bins24");
    const reference::Volume normalised = reference::normalised_reflectors(
        *bins, swept(), {cascade}, {&white}, {&reflectors}, bounces)[0];
    const reference::Volume swept_light =
        reference::sweep_bounced(*bins, swept(), {cascade}, {&normalised}, bounces)[0];
    double sum = 0;
    reference::for_each_cell(kGrid, [&](const glm::ivec3& p) {
      if (!inside(p)) return;
      for (int b = 0; b < kSweepBins; ++b) sum += swept_light.value(1, b, p.x, p.y, p.z);
    });
    return sum;
  }
};

// The series E (1 + b + b^2 + ...) of a furnace. b is 0.81 of the albedo: no links are closed here,
// so the white furnace, whose border is white, has 1.24 inside.
TEST(Bounce, AFurnaceMatchesItsClosedForm) {
  for (const float albedo : {0.2f, 0.5f, 0.8f, 0.95f}) {
    const Room room(albedo);
    const double one = room.lit(Bounces::one), reflected = room.lit(Bounces::two) / one - 1;
    EXPECT_NEAR(reflected, 0.808 * albedo, 0.01 * albedo);
    EXPECT_NEAR(room.lit(Bounces::all) / one * (1 - reflected), 1, 0.06 * albedo) << albedo;
  }
}

RenderOptions small_frame(Bounces bounces, int cascades) {
  RenderOptions options = small_sweep();
  options.bounces = bounces, options.cascades = cascades;
  options.width = 48, options.height = 27, options.cascade_size = cascades == 1 ? 1.5 : 0.75;
  options.rsm_size = 64, options.shadow_size = 64;
  return options;
}

/// Sum of the irradiance of all pixels.
double irradiance(const RenderOptions& options, const SceneData& scene, const SceneCamera& camera) {
  Frame frame(test_session(), scene, options);
  frame.render(camera);
  const std::vector<float> pixels = frame.read(Show::irradiance);
  double sum = 0;
  for (std::size_t i = 0; i < pixels.size(); ++i) sum += i % 4 == 3 ? 0.0 : double{pixels[i]};
  return sum;
}

double irradiance(const RenderOptions& options, const char* file = "scenes/cornell.json") {
  const SceneData scene = load_scene(std::filesystem::path(CLPV_SOURCE_DIR) / file);
  return irradiance(options, scene, scene.camera(""));
}

// A lamp close under a ceiling: path tracing finds 1.29 times the light of two bounces. It was 1.65
// times when all later bounces left from where the second did.
TEST(BouncedFrame, LaterBouncesLeaveALamp) {
  const char* lamp = "scenes/cornell_lamp.json";
  RenderOptions two = small_frame(Bounces::two, 2), all = small_frame(Bounces::all, 2);
  for (RenderOptions* options : {&two, &all}) {
    options->grid = 32, options->cascade_size = 2;
    options->directions = options->coarser_directions = Directions::of96;
  }
  EXPECT_NEAR(irradiance(all, lamp) / irradiance(two, lamp), 1.29, 0.15);
}

/// Mean of irradiance() by all bounces over that by one, in a closed box that emits on all of its
/// faces: eight cells of the coarsest of three cascades along each edge, seen by an eye that has
/// one face within the finest cascade.
double furnace_series(float albedo) {
  SceneData scene;
  const unsigned material = add_material(scene, glm::vec3(albedo));
  for (float& emitted : scene.materials[material].emissive) emitted = 1;
  add_box(scene, glm::vec3(-4.1f, -3.9f, -4.05f), 8, material);
  const auto light = [&](Bounces bounces) {
    RenderOptions options = small_frame(bounces, 3);
    options.cascade_size = 4;
    return irradiance(options, scene, camera_at({-2.5f, 0.4f, 0.7f}, {0.2f, -0.1f, 1}));
  };
  return light(Bounces::all) / light(Bounces::one);
}

// The series 1 + a + a^2 + ... over three cascades. Errors grow with 1 / (1 - a): a white furnace
// may be too dark, never too bright. It is too dark as walls are one sheet, beyond which the white
// furnace is white and shines in at edges.
TEST(BouncedFrame, FurnacesOfThreeCascadesMatchTheirClosedForm) {
  EXPECT_NEAR(furnace_series(0.2f) * 0.8, 1, 0.02);
  EXPECT_NEAR(furnace_series(0.5f) * 0.5, 1, 0.06);
  EXPECT_NEAR(furnace_series(0.8f) * 0.2, 1, 0.12);
  const double white = furnace_series(0.95f) * 0.05;
  EXPECT_LE(white, 1);
  EXPECT_GE(white, 0.6);
}

// A finer cascade takes the coarser one's bounced light through its border once, and adds only its
// own bounces.
TEST(BouncedFrame, CascadesDoNotCountLightTwice) {
  for (const Bounces bounces : {Bounces::two, Bounces::all}) {
    const double share =
        irradiance(small_frame(bounces, 1)) / irradiance(small_frame(Bounces::one, 1));
    EXPECT_NEAR(irradiance(small_frame(bounces, 2)) / irradiance(small_frame(Bounces::one, 2)),
                share, 0.1 * share);
  }
}

}  // namespace clpv::bounce_test
