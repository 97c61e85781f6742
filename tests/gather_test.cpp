// SPDX-License-Identifier: MIT
// Gathering against closed forms: uniform and linear fields, seams between cascades, clamp.
// Every field is gathered by the kernels and by the CPU reference, and both are held against mathematics.
#include "pipeline/gather.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>

#include "pipeline/cascade.hpp"
#include "pipeline/visibility.hpp"
#include "reference/visibility.hpp"
#include "support/error.hpp"
#include "tests/support/gather_fields.hpp"
#include "tests/support/scene_builder.hpp"

namespace clpv::gather_test {
namespace {

using std::numbers::pi;
using namespace test;

TEST(Gather, UniformLightIsTheSameEverywhereInside) {
  for (const char* name : {"sh2", "sh3", "srbf4", "srbf8v2"}) {
    SCOPED_TRACE(name);
    const std::unique_ptr<Basis> basis = make_basis(name);
    const std::vector<double> c = times(1.75, basis->constant());
    const SurfaceImage image = walk({-0.98, 0.9, -0.9}, {0.97, -0.98, 0.9}, kTilted);
    const Both both = gather(*basis, TransportKind::sampled, {}, {uniform(c)}, image);
    expect_all(both, 4 * basis->value(c, -kTilted) / (kCell * kCell));  // spherical harmonics: 4 . 1.75 / s^2
  }
}

TEST(Gather, SweptUniformRadianceIsPiL) {
  const std::unique_ptr<Basis> basis = make_basis("sh2");
  const double radiance = 2.5;
  const std::vector<double> c = times(radiance * kCell * kCell, basis->constant());
  for (const glm::dvec3& n : {kTilted, glm::dvec3(0, 0, 1), glm::dvec3(-1, 0, 0)}) {
    const Both both = gather(*basis, TransportKind::sweep, {}, {uniform(c)}, walk({-1, 0, 0}, {1, 0, 0}, n));
    expect_all(both, pi * radiance);
  }
}

TEST(Gather, SweptLightIsIntegratedOverTheClampedCosine) {
  const std::unique_ptr<Basis> basis = make_basis("srbf8v2");
  std::mt19937 random(5);
  std::uniform_real_distribution<double> positive(0.1, 1);
  std::vector<double> c(8), alpha(8);
  for (double& value : c) value = positive(random);
  basis->cosine_integrals(-kTilted, alpha);
  double expected = 0;
  for (std::size_t i = 0; i < 8; ++i) expected += alpha[i] * c[i];
  const Both both =
      gather(*basis, TransportKind::sweep, {}, {uniform(c)}, walk({-1, 0, 0}, {1, 0, 0}, kTilted));
  expect_all(both, expected / (kCell * kCell));
}

TEST(Gather, LinearLightIsReproducedWithTheOffset) {
  const std::unique_ptr<Basis> basis = make_basis("sh2");
  const glm::dvec3 slope(0.3, -0.2, 0.5);  // per cell
  const auto intensity = [&](const glm::dvec3& cells) { return 6 + glm::dot(slope, cells); };
  const reference::Volume light = volume_of(4, [&](int channel, const glm::dvec3& centre) {
    return times((channel + 1) * intensity(centre), basis->constant());
  });
  const glm::dvec3 from(-0.98, 0.8, -0.9), to(0.97, -0.95, 0.95);
  for (const double offset : {0.5, 0.75, 0.0}) {
    const Both both =
        gather(*basis, TransportKind::sampled, {.gather_offset = offset}, {light}, walk(from, to, kTilted));
    const auto expected = [&](std::size_t pixel) {
      const glm::dvec3 p(along(from.x, to.x, pixel), along(from.y, to.y, pixel), along(from.z, to.z, pixel));
      return 4 * intensity(p / double{kCell} + kGrid / 2.0 + offset * kTilted) / (kCell * kCell);
    };
    expect_all(both, expected, 3 * 4 * 10 / (kCell * kCell), 2 * kFloat);
  }
}

TEST(Gather, CascadesHandOverWithoutASeam) {
  const std::unique_ptr<Basis> basis = make_basis("sh2");
  const double fine = 5, coarse = 2;  // E of the two
  const std::vector<reference::Volume> light = {
      uniform(times(fine / 4 * kCell * kCell, basis->constant())),
      uniform(times(coarse / 4 * 4 * kCell * kCell, basis->constant()))};
  // From inside the finer cascade (boundary at 2.5 m) through the coarser (5 m) and out.
  const double from = 1, to = 7;
  const SurfaceImage image = walk({from, 0.1, 0.2}, {to, 0.1, 0.2}, {0, 1, 0});
  const Both both = gather(*basis, TransportKind::sampled, {.blend_cells = 3}, light, image);
  const auto expected = [&](std::size_t pixel) {
    const double x = along(from, to, pixel);
    const double in_fine = std::clamp((2.5 - x) / (3 * kCell), 0.0, 1.0);
    const double in_coarse = std::clamp((5 - x) / (3 * 2 * kCell), 0.0, 1.0);
    return in_fine * fine + (1 - in_fine) * in_coarse * coarse;
  };
  expect_all(both, expected, 3 * fine, 2 * kFloat);
  for (std::size_t pixel = 1; pixel < kPixels; ++pixel) {
    const double step = std::abs(both.device[pixel].x - both.device[pixel - 1].x);
    ASSERT_LE(step, 1.01 * fine / (3 * kCell) * (to - from) / kPixels) << "a jump at pixel " << pixel;
  }
  EXPECT_EQ(both.device.back(), glm::dvec3(0)) << "outside all cascades";
}

TEST(Gather, SharesDoNotJumpWhereTheEyeCrossesIntoAnotherCell) {
  const std::unique_ptr<Basis> basis = make_basis("sh2");
  const reference::Volume fine = uniform(times(5, basis->constant())), coarse = uniform(basis->constant());
  const auto seen_from = [&](float eye, const glm::dvec3& p) {
    const auto grids = cascade_grids({eye, 0.1f, 0.2f}, 2, double{kCell} * kGrid, kGrid);
    return reference::gather(*basis, TransportKind::sampled, {.grid = kGrid},
                             {{grids[0], &fine}, {grids[1], &coarse}}, p, glm::dvec3(0, 1, 0))
        .x;
  };
  const float boundary = 2 * kCell;  // of both cascades' cells
  EXPECT_NE(cascade_grids({boundary - 1e-5f, 0, 0}, 1, double{kCell} * kGrid, kGrid)[0].origin[0],
            cascade_grids({boundary + 1e-5f, 0, 0}, 1, double{kCell} * kGrid, kGrid)[0].origin[0]);
  double most = 0;
  for (int i = 0; i < 200; ++i) {
    const glm::dvec3 p(-6 + 0.07 * i, 0.3, -0.2);
    const double before = seen_from(boundary - 1e-5f, p);
    most = std::max(most, before);
    EXPECT_NEAR(seen_from(boundary + 1e-5f, p), before, 1e-3 * 4 * 5 / (kCell * kCell)) << p.x;
  }
  EXPECT_GT(most, 4 * 5 / (kCell * kCell) * 0.9);
}

TEST(Gather, OutsideAllCascadesIsExactlyDark) {
  const std::unique_ptr<Basis> basis = make_basis("sh2");
  const std::vector<reference::Volume> light = {uniform(basis->constant()), uniform(basis->constant())};
  for (const glm::dvec3& axis : {glm::dvec3(1, 0, 0), glm::dvec3(0, -1, 0), glm::dvec3(0, 0, 1)}) {
    const Both both =
        gather(*basis, TransportKind::sampled, {}, light, walk(5.001 * axis, 900.0 * axis, -axis));
    for (const glm::dvec3& e : both.device) ASSERT_EQ(e, glm::dvec3(0));
  }
}

TEST(Gather, EmptyVolumesAreExactlyDark) {
  const std::unique_ptr<Basis> basis = make_basis("srbf8v2");
  const Both both = gather(*basis, TransportKind::sampled, {}, {uniform(std::vector<double>(8, 0.0))},
                           walk({-4, 0, 0}, {4, 0, 0}, kTilted));
  for (const cl_float4& e : both.raw) {
    for (const float value : e.s) ASSERT_EQ(value, 0.0f);
  }
}

TEST(Gather, BackgroundIsExactlyDark) {
  const std::unique_ptr<Basis> basis = make_basis("sh2");
  SurfaceImage image = walk({-1, 0, 0}, {1, 0, 0}, kTilted);
  for (unsigned pixel = 0; pixel < kPixels; pixel += 2) {
    image.depth[pixel] = 0;
    image.normal[pixel] = glm::vec4(0);
  }
  const Both both = gather(*basis, TransportKind::sampled, {}, {uniform(basis->constant())}, image);
  for (unsigned pixel = 0; pixel < kPixels; ++pixel) {
    ASSERT_EQ(both.device[pixel] == glm::dvec3(0), pixel % 2 == 0) << "pixel " << pixel;
    ASSERT_EQ(both.raw[pixel].s[3], 0.0f);
  }
}

TEST(Gather, NegativeLightIsClamped) {
  // All light travels towards +z; sh2's lobe is negative backwards, at a surface that faces +z.
  const std::unique_ptr<Basis> basis = make_basis("sh2");
  const std::vector<double> c = basis->clamped_cosine({0, 0, 1});
  ASSERT_LT(basis->value(c, {0, 0, -1}), 0);
  const SurfaceImage image = walk({-1, 0, 0}, {1, 0, 0}, {0, 0, 1});
  // Int (1/4 + cos/2) max(0, -cos) dw = pi/4 - pi/3 is negative too.
  for (const TransportKind transport : {TransportKind::sampled, TransportKind::sweep})
    expect_all(gather(*basis, transport, {}, {uniform(c)}, image), 0);
}

/// Light in front of a wall across x through the origin, none behind it.
struct Walled {
  reference::Volume light;
  std::vector<std::uint8_t> hidden;
};

Walled walled(const Basis& basis) {
  Scene wall;
  test::add_quad(wall, {0, -9, -9}, {0, 20, 0}, {0, 0, 20}, test::add_material(wall));
  return {volume_of(4,
                    [&](int channel, const glm::dvec3& centre) {
                      const bool in_front = centre.x < kGrid / 2.0;
                      return times(in_front ? (channel + 1) * 2.0 : 0.0, basis.constant());
                    }),
          reference::see(wall, grid_of(0)).least};
}

TEST(Gather, OfCellsBehindAWallNothingIsSeenIfAsked) {
  const auto basis = make_basis("sh2");
  const Walled scene = walled(*basis);
  const double lit = 4 * 2.0 / (kCell * kCell);
  const auto on_wall = [&](double side, Gathering gathering) {
    const SurfaceImage image = walk({side * 1e-4, -0.98, -0.9}, {side * 1e-4, 0.97, 0.95}, {side, 0, 0});
    return gather(*basis, TransportKind::sampled, {.gather = gathering, .gather_offset = 0.25}, {scene.light},
                  image, scene.hidden);
  };
  const auto is = [](double e) { return [e](std::size_t) { return e; }; };
  expect_all(on_wall(-1, Gathering::visible), is(lit), 3 * lit, kFloat);
  expect_all(on_wall(1, Gathering::visible), is(0), 3 * lit, kFloat);
  // Else a quarter of a cell off the wall three quarters are from its own side, and a quarter is from beyond.
  const double own = 0.75 + 1e-4 / kCell;
  expect_all(on_wall(-1, Gathering::all), is(own * lit), 3 * lit, kFloat);
  expect_all(on_wall(1, Gathering::all), is((1 - own) * lit), 3 * lit, kFloat);
}

TEST(Gather, WhereNothingIsSeenAllCellsCount) {
  const auto basis = make_basis("sh2");
  const SurfaceImage image = walk({-1, 0.1, 0.3}, {1, -0.2, 0.1}, kTilted);
  const std::vector<std::uint8_t> nothing(CellVisibility::bytes(kGrid), 0xff);
  const Both both = gather(*basis, TransportKind::sampled, {.gather = Gathering::visible},
                           {uniform(times(1.75, basis->constant()))}, image, nothing);
  expect_all(both, 4 * 1.75 / (kCell * kCell));
}

TEST(Gather, LightIsContinuousWhereCellsGoOutOfSight) {
  const auto basis = make_basis("sh2");
  Scene wall;  // ends within the grid: behind its edge cells come into sight
  test::add_quad(wall, {0, -9, -9}, {0, 9, 0}, {0, 0, 20}, test::add_material(wall));
  const std::vector<std::uint8_t> hidden = reference::see(wall, grid_of(0)).least;
  const SurfaceImage image = walk({0.1, -0.4, 0.13}, {0.1, 0.4, 0.13}, {0, 0, 1});
  const Both both =
      gather(*basis, TransportKind::sampled, {.gather = Gathering::visible, .gather_offset = 0.25},
             {walled(*basis).light}, image, hidden);
  const double lit = 4 * 2.0 / (kCell * kCell), step = 0.8 / kCell / kPixels;  // [cells]
  EXPECT_LT(both.device.front().x, 0.05 * lit);
  EXPECT_GT(both.device.back().x, 0.2 * lit);
  for (std::size_t pixel = 1; pixel < kPixels; ++pixel)
    ASSERT_LT(std::abs(both.device[pixel].x - both.device[pixel - 1].x), 12 * step * lit) << pixel;
}

TEST(Gather, RejectsWhatDoesNotFit) {
  const std::unique_ptr<Basis> basis = make_basis("sh2");
  Gatherer gatherer(test_session(), *basis, TransportKind::sampled, {.grid = kGrid});
  const Volume small(test_session(), {kGrid - 1, 4, 3}, "test: light");
  Buffer e = test_session().buffer(kPixels * sizeof(cl_float4), "test: E");
  Surface camera;
  EXPECT_THROW(gatherer.gather(camera, {grid_of(0)}, {&small}, e), Error);
  EXPECT_THROW(gatherer.gather(camera, {grid_of(0)}, {}, e), Error);
}

TEST(Gather, KernelsAgreeWithTheReference) {
  expect_passed(reference::check(Stage::gather, test_session(), test::few_variants()));
}

}  // namespace
}  // namespace clpv::gather_test
