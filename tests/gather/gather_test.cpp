// SPDX-License-Identifier: MIT
// Gathering against closed forms, by the CPU reference: uniform and linear fields, seams between
// cascades, clamping, visibility.
#include "pipeline/gather/gather.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <random>

#include "pipeline/frame/cascade.hpp"
#include "pipeline/voxels/voxel_field.hpp"
#include "reference/blockers.hpp"
#include "reference/gather.hpp"
#include "support/error.hpp"
#include "tests/support/numbers.hpp"
#include "tests/support/on_device.hpp"
#include "tests/support/scene_builder.hpp"

namespace clpv::gather_test {
using namespace test;

constexpr int kGrid = 12;        // cells of a cascade along each axis
constexpr float kCell = 0.5f;    // cell of the finest cascade [m]
constexpr double kFloat = 1e-6;  // relative: positions and normals are float32
constexpr unsigned kPixels = 241;

/// Grid `c`, its middle at the origin; each next cascade has cells twice as large.
ClpvGrid grid_of(int c) {
  ClpvGrid grid{};
  grid.cell = kCell * static_cast<float>(1 << c);
  grid.n = kGrid;
  for (float& o : grid.origin) o = -grid.cell * (kGrid / 2);
  return grid;
}

/// Coefficients of a channel in a cell whose centre is at that point, in cells from the grid's
/// origin.
using Fill = std::function<std::vector<double>(int channel, const glm::dvec3& centre)>;

reference::Volume volume_of(int coefficients, const Fill& fill) {
  reference::Volume volume(kGrid, coefficients);
  reference::for_each_cell(kGrid, [&](const glm::ivec3& p) {
    for (int channel = 0; channel < 3; ++channel) {
      const std::vector<double> c = fill(channel, glm::dvec3(p) + 0.5);
      for (int i = 0; i < coefficients; ++i)
        volume.at(channel, i, p.x, p.y, p.z) = c[static_cast<std::size_t>(i)];
    }
  });
  return volume;
}

/// c, 2 c, 3 c in the three channels of every cell.
reference::Volume uniform(const std::vector<double>& c) {
  return volume_of(static_cast<int>(c.size()), [&](int channel, const glm::dvec3&) {
    std::vector<double> scaled = c;
    for (double& value : scaled) value *= channel + 1;  // channels must not be mixed up
    return scaled;
  });
}

/// Surfaces of one normal, pixel i of kPixels at from + (i + 1/2) / kPixels (to - from) [m], seen
/// from their front.
SurfaceImage walk(const glm::dvec3& from, const glm::dvec3& to, const glm::dvec3& normal) {
  const glm::dvec3 right = glm::normalize(to - from),
                   off = std::abs(glm::dot(normal, right)) < 0.9 ? normal : glm::dvec3(0.6, 0.8, 0);
  const glm::dvec3 up = glm::normalize(glm::cross(off, right)), forward = -glm::cross(right, up);
  const glm::dvec3 eye = (from + to) / 2.0 - forward;
  SurfaceImage image;
  ClpvView& view = image.view;
  view.orthographic = 1;
  for (int i = 0; i < 3; ++i) {
    view.eye[i] = static_cast<float>(eye[i]), view.right[i] = static_cast<float>(right[i]);
    view.up[i] = static_cast<float>(up[i]), view.forward[i] = static_cast<float>(forward[i]);
  }
  view.half_width = static_cast<float>(glm::length(to - from) / 2), view.half_height = 1;
  view.width = kPixels, view.height = 1, view.far_depth = 10;
  image.depth.assign(kPixels, 1.0f);
  image.normal.assign(kPixels, glm::vec4(glm::vec3(normal), 0));
  return image;
}

/// Irradiance E [W/m^2] of each pixel, by the CPU reference, from volumes of grid_of(0),
/// grid_of(1), ... `occluded`: bytes as VoxelField stores them.
std::vector<glm::dvec3> gather(const Basis& basis, TransportKind transport, GatherOptions options,
                               const std::vector<reference::Volume>& light,
                               const SurfaceImage& image,
                               const std::vector<std::uint8_t>& occluded = {}) {
  options.grid = kGrid;
  std::vector<reference::Cascade> cascades;
  for (std::size_t c = 0; c < light.size(); ++c) {
    cascades.push_back({grid_of(static_cast<int>(c)), &light[c]});
    if (!occluded.empty())
      cascades[c].occluded = occluded.data() + c * occluded.size() / light.size();
  }
  return reference::gather(basis, transport, options, cascades, image);
}

/// Expects E of every pixel to be `expected(pixel)` times 1, 2, 3 in the three channels.
void expect_all(const std::vector<glm::dvec3>& found,
                const std::function<double(std::size_t)>& expected, double scale) {
  for (std::size_t pixel = 0; pixel < found.size(); ++pixel) {
    for (int channel = 0; channel < 3; ++channel)
      ASSERT_NEAR(found[pixel][channel], expected(pixel) * (channel + 1), kFloat * scale)
          << "pixel " << pixel << " channel " << channel;
  }
}

void expect_all(const std::vector<glm::dvec3>& found, double expected) {
  expect_all(
      found, [&](std::size_t) { return expected; }, 3 * std::abs(expected));
}

/// Where the pixel of a walk is on one axis [m].
double along(double from, double to, std::size_t pixel) {
  return from + (to - from) * (static_cast<double>(pixel) + 0.5) / kPixels;
}

const glm::dvec3 kTilted = glm::normalize(glm::dvec3(1, -2, 0.5));

TEST(Gather, SweptLightIsIntegratedOverTheClampedCosine) {
  const std::unique_ptr<Basis> basis = make_basis("srbf8v2");
  std::mt19937 random(5);
  std::uniform_real_distribution<double> positive(0.1, 1);
  std::vector<double> c(8), alpha(8);
  for (double& value : c) value = positive(random);
  basis->cosine_integrals(-kTilted, alpha);
  double expected = 0;
  for (std::size_t i = 0; i < 8; ++i) expected += alpha[i] * c[i];
  const std::vector<glm::dvec3> found =
      gather(*basis, TransportKind::sweep, {}, {uniform(c)}, walk({-1, 0, 0}, {1, 0, 0}, kTilted));
  expect_all(found, expected / (kCell * kCell));
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
    const std::vector<glm::dvec3> found =
        gather(*basis, TransportKind::sampled, {.gather_offset = offset}, {light},
               walk(from, to, kTilted));
    const auto expected = [&](std::size_t pixel) {
      const glm::dvec3 p(along(from.x, to.x, pixel), along(from.y, to.y, pixel),
                         along(from.z, to.z, pixel));
      return 4 * intensity(p / double{kCell} + kGrid / 2.0 + offset * kTilted) / (kCell * kCell);
    };
    expect_all(found, expected, 3 * 4 * 10 / (kCell * kCell));
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
  const std::vector<glm::dvec3> found =
      gather(*basis, TransportKind::sampled, {.blend_cells = 3}, light, image);
  const auto expected = [&](std::size_t pixel) {
    const double x = along(from, to, pixel);
    const double in_fine = std::clamp((2.5 - x) / (3 * kCell), 0.0, 1.0);
    const double in_coarse = std::clamp((5 - x) / (3 * 2 * kCell), 0.0, 1.0);
    return in_fine * fine + (1 - in_fine) * in_coarse * coarse;
  };
  expect_all(found, expected, 3 * fine);
  for (std::size_t pixel = 1; pixel < kPixels; ++pixel) {
    const double step = std::abs(found[pixel].x - found[pixel - 1].x);
    ASSERT_LE(step, 1.01 * fine / (3 * kCell) * (to - from) / kPixels)
        << "a jump at pixel " << pixel;
  }
  EXPECT_EQ(found.back(), glm::dvec3(0)) << "outside all cascades";
}

TEST(Gather, SharesDoNotJumpWhereTheEyeCrossesIntoAnotherCell) {
  const std::unique_ptr<Basis> basis = make_basis("sh2");
  const reference::Volume fine = uniform(times(5, basis->constant())),
                          coarse = uniform(basis->constant());
  const auto seen_from = [&](float eye, const glm::dvec3& p) {
    const auto grids = cascade_grids({eye, 0.1f, 0.2f}, 2, double{kCell} * kGrid, kGrid);
    return reference::gather(*basis, TransportKind::sampled, {.grid = kGrid},
                             {{grids[0], &fine}, {grids[1], &coarse}}, p, glm::dvec3(0, 1, 0),
                             glm::dvec3(0, 1, 0))
        .x;
  };
  const float boundary = 2 * kCell;  // boundary of both cascades' cells
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
  std::vector<std::uint8_t> occluded;
};

Walled walled(const Basis& basis) {
  SceneData wall;
  add_quad(wall, {0, -9, -9}, {0, 20, 0}, {0, 0, 20}, add_material(wall));
  return {volume_of(4,
                    [&](int channel, const glm::dvec3& centre) {
                      const bool in_front = centre.x < kGrid / 2.0;
                      return times(in_front ? (channel + 1) * 2.0 : 0.0, basis.constant());
                    }),
          reference::occlude(wall, grid_of(0)).lower};
}

TEST(Gather, HiddenCellsDoNotLightASurface) {
  const auto basis = make_basis("sh2");
  const Walled scene = walled(*basis);
  const double lit = 4 * 2.0 / (kCell * kCell);
  const auto on_wall = [&](double side, Gathering gathering) {
    const SurfaceImage image =
        walk({side * 1e-4, -0.98, -0.9}, {side * 1e-4, 0.97, 0.95}, {side, 0, 0});
    return gather(*basis, TransportKind::sampled, {.gather = gathering, .gather_offset = 0.25},
                  {scene.light}, image, scene.occluded);
  };
  const auto is = [](double e) { return [e](std::size_t) { return e; }; };
  expect_all(on_wall(-1, Gathering::visible), is(lit), 3 * lit);
  expect_all(on_wall(1, Gathering::visible), is(0), 3 * lit);
  // Else a quarter of a cell off the wall three quarters are from its own side, and a quarter is
  // from beyond.
  const double own = 0.75 + 1e-4 / kCell;
  expect_all(on_wall(-1, Gathering::all), is(own * lit), 3 * lit);
  expect_all(on_wall(1, Gathering::all), is((1 - own) * lit), 3 * lit);
}

TEST(Gather, AllCellsCountWhereNoneIsVisible) {
  const auto basis = make_basis("sh2");
  const SurfaceImage image = walk({-1, 0.1, 0.3}, {1, -0.2, 0.1}, kTilted);
  const std::vector<std::uint8_t> nothing(visibility_bytes(kGrid), 0xff);
  const std::vector<glm::dvec3> found =
      gather(*basis, TransportKind::sampled, {.gather = Gathering::visible},
             {uniform(times(1.75, basis->constant()))}, image, nothing);
  expect_all(found, 4 * 1.75 / (kCell * kCell));
}

TEST(Gather, LightIsContinuousWhereCellsBecomeHidden) {
  const auto basis = make_basis("sh2");
  SceneData wall;  // ends within the grid: behind its edge cells come into sight
  add_quad(wall, {0, -9, -9}, {0, 9, 0}, {0, 0, 20}, add_material(wall));
  const std::vector<std::uint8_t> occluded = reference::occlude(wall, grid_of(0)).lower;
  const SurfaceImage image = walk({0.1, -0.4, 0.13}, {0.1, 0.4, 0.13}, {0, 0, 1});
  const std::vector<glm::dvec3> found =
      gather(*basis, TransportKind::sampled, {.gather = Gathering::visible, .gather_offset = 0.25},
             {walled(*basis).light}, image, occluded);
  const double lit = 4 * 2.0 / (kCell * kCell), step = 0.8 / kCell / kPixels;  // [cells]
  EXPECT_LT(found.front().x, 0.05 * lit);
  EXPECT_GT(found.back().x, 0.2 * lit);
  for (std::size_t pixel = 1; pixel < kPixels; ++pixel)
    ASSERT_LT(std::abs(found[pixel].x - found[pixel - 1].x), 12 * step * lit) << pixel;
}

TEST(Gather, RejectsWhatDoesNotFit) {
  const std::unique_ptr<Basis> basis = make_basis("sh2");
  Gatherer gatherer(test_session(), *basis, TransportKind::sampled, {.grid = kGrid});
  const Volume small(test_session(), {kGrid - 1, 4, 3}, "test: light");
  Buffer e = test_session().buffer(kPixels * sizeof(cl_float4), "test: E");
  Surface camera;
  EXPECT_THROW(gatherer.gather(camera, {{grid_of(0)}, {&small}}, e), Error);
  EXPECT_THROW(gatherer.gather(camera, {{grid_of(0)}, {}}, e), Error);
}

}  // namespace clpv::gather_test
