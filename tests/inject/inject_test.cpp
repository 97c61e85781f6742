// SPDX-License-Identifier: MIT
// Injection against closed forms: position and flux of light, blockers, several surfaces,
// repeatability.
#include "pipeline/inject/inject.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <random>
#include <vector>

#include "kernels/shared/sort.h"
#include "pipeline/inject/lookup_table.hpp"
#include "pipeline/inject/sort_by_cell.hpp"
#include "support/error.hpp"
#include "tests/support/error_of.hpp"
#include "tests/support/numbers.hpp"
#include "tests/support/on_device.hpp"
#include "verify/jobs.hpp"

namespace clpv::inject_test {
using test::test_session;

constexpr int kGrid = 8;
constexpr float kCell = 0.5f;
constexpr double kPi = std::numbers::pi;
// Sums of up to some thousand texels in single precision.
constexpr double kRounding = 2e-6;

const ClpvGrid kCells = {{-2, -2, -2}, kCell, kGrid, {}};

/// Looks down on the xz plane from y = 10: x to the right, z downwards. Texels of the given edge
/// [m] around (0, 0).
ClpvView from_above(unsigned width, unsigned height, float edge) {
  ClpvView view{};
  view.eye[1] = 10, view.orthographic = 1, view.far_depth = 100;
  view.right[0] = 1, view.up[2] = -1, view.forward[1] = -1;
  view.half_width = 0.5f * edge * static_cast<float>(width);
  view.half_height = 0.5f * edge * static_cast<float>(height);
  view.width = width, view.height = height;
  return view;
}

SurfaceImage empty_surface(const ClpvView& view) {
  const std::size_t count = std::size_t{view.width} * view.height;
  return {view,
          std::vector<float>(count),
          std::vector<glm::vec4>(count),
          std::vector<glm::vec4>(count),
          {}};
}

/// A horizontal plane at `height` [m] seen from above, its normal up, `flux` [W] a texel.
SurfaceImage plane(const ClpvView& view, float height, const glm::vec3& flux = glm::vec3(1)) {
  SurfaceImage surface = empty_surface(view);
  std::fill(surface.depth.begin(), surface.depth.end(), view.eye[1] - height);
  std::fill(surface.normal.begin(), surface.normal.end(), glm::vec4(0, 1, 0, 0));
  std::fill(surface.colour.begin(), surface.colour.end(), glm::vec4(flux, 0));
  return surface;
}

/// One texel at `position`, seen from above, with that normal and flux.
SurfaceImage one_texel(const glm::vec3& position, const glm::vec3& normal, const glm::vec3& flux) {
  ClpvView view = from_above(1, 1, 0.01f);
  view.eye[0] = position.x, view.eye[2] = position.z;
  SurfaceImage surface = plane(view, position.y, flux);
  surface.normal[0] = glm::vec4(glm::normalize(normal), 0);
  return surface;
}

struct Injection {
  VolumeShape shape;
  std::vector<float> values;

  std::vector<double> cell(int channel, int x, int y, int z) const {
    std::vector<double> c;
    for (int i = 0; i < shape.coefficients; ++i) {
      c.push_back(values[static_cast<std::size_t>(
          (((channel * shape.coefficients + i) * shape.n + z) * shape.n + y) * shape.n + x)]);
    }
    return c;
  }
  /// Sum over all cells of coefficient i, as a coefficient vector.
  std::vector<double> total(int channel) const {
    std::vector<double> sum;
    const auto samples = static_cast<std::ptrdiff_t>(shape.n) * shape.n * shape.n;
    for (int i = 0; i < shape.coefficients; ++i) {
      const auto first = values.begin() + (channel * shape.coefficients + i) * samples;
      sum.push_back(std::accumulate(first, first + samples, 0.0));
    }
    return sum;
  }
};

Injection light_of(const Basis& basis, const SurfaceImage& image, InjectOptions options = {}) {
  Session& session = test_session();
  options.grid = kGrid;
  Volume light(session, {kGrid, basis.size(), 3}, "light");
  Injector(session, basis, options).inject_light(upload_surface(session, image), kCells, light);
  return {light.shape(), light.read(session)};
}

Injection geometry_of(const Basis& basis, const std::vector<SurfaceImage>& images,
                      InjectOptions options = {}) {
  Session& session = test_session();
  options.grid = kGrid;
  Volume geometry(session, {kGrid + 1, blocking_size(options.blocking, basis), 1}, "geometry");
  Injector injector(session, basis, options);
  for (const SurfaceImage& image : images) {
    injector.inject_geometry(upload_surface(session, image), kCells, geometry);
  }
  return {geometry.shape(), geometry.read(session)};
}

bool all_zero(const Injection& injection) {
  return std::all_of(injection.values.begin(), injection.values.end(),
                     [](float v) { return v == 0.0f; });
}

struct EachBasis : ::testing::TestWithParam<const char*> {
  std::unique_ptr<Basis> basis = make_basis(GetParam());
};
INSTANTIATE_TEST_SUITE_P(Inject, EachBasis, testing::Values("sh2", "srbf8v2"),
                         [](const auto& info) { return std::string(info.param); });

TEST_P(EachBasis, OneTexelIsALobeHalfACellOffItsSurface) {
  const glm::vec3 normal = glm::normalize(glm::vec3(-2, 1, -3)), flux(0.5f, 1, 2);
  // The texel is in cell (4, 4, 4); its light is moved by (-0.267, 0.134, -0.401) cells out of
  // (4.1, 4.9, 4.2).
  const SurfaceImage texel = one_texel({0.05f, 0.45f, 0.1f}, normal, flux);
  const Injection light = light_of(*basis, texel);
  const std::vector<double> lobe = basis->clamped_cosine(glm::dvec3(normal));
  for (int channel = 0; channel < 3; ++channel) {
    EXPECT_THAT(
        light.cell(channel, 3, 5, 3),
        testing::Pointwise(testing::DoubleNear(1e-5), test::times(flux[channel] / kPi, lobe)));
  }
  const std::vector<double> all = light.total(0), there = light.cell(0, 3, 5, 3);
  EXPECT_EQ(all, there) << "other cells are not empty";
}

TEST_P(EachBasis, TotalEnergyIsTheFluxOfAllTexels) {
  // 4096 texels of 1/32 m: 256 to a cell, in many segments; 0.3 m is in the middle of a layer of
  // cells.
  const SurfaceImage floor = plane(from_above(64, 64, 1.0f / 32), 0.3f, {1, 0.25f, 0});
  const double lobe_flux = basis->energy(basis->clamped_cosine({0, 1, 0})) / kPi;
  EXPECT_NEAR(lobe_flux, 1, basis->centres().empty() ? 1e-12 : 1.5e-3);
  const Injection light = light_of(*basis, floor);
  EXPECT_NEAR(basis->energy(light.total(0)), 4096 * lobe_flux, 4096 * kRounding);
  EXPECT_NEAR(basis->energy(light.total(1)), 1024 * lobe_flux, 1024 * kRounding);
  EXPECT_EQ(basis->energy(light.total(2)), 0);
}

TEST(LookupTable, RejectsImagesThatTheDeviceLacks) {
  Device without = choose_device();
  without.images = false;
  Session other(without);
  const auto basis = make_basis("srbf4");
  EXPECT_THAT(test::error_of(ExitCode::device,
                             [&] {
                               LookupTable(other, *basis, {.kind = LobeKind::rotate},
                                           TableStorage::image, TableUse::lobes);
                             }),
              ::testing::HasSubstr("no images"));
}

TEST_P(EachBasis, UnitFluxLobesCarryExactlyTheFlux) {
  const SurfaceImage texel = one_texel({0.1f, 0.1f, 0.1f}, {1, 2, 3}, {1, 2, 3});
  const Injection light = light_of(*basis, texel, {.unit_flux_lobes = true});
  for (int channel = 0; channel < 3; ++channel) {
    EXPECT_NEAR(basis->energy(light.total(channel)), channel + 1, 3 * kRounding);
  }
}

TEST(Inject, WhatIsOutsideTheGridIsDropped) {
  const auto basis = make_basis("sh2");
  for (const glm::vec3 p : {glm::vec3(2.01f, 0, 0), glm::vec3(0, -2.3f, 0), glm::vec3(0, 0, -2.01f),
                            glm::vec3(0, 9, 0)}) {
    const SurfaceImage texel = one_texel(p, {0, 1, 0}, glm::vec3(1));
    EXPECT_TRUE(all_zero(light_of(*basis, texel))) << p.x << " " << p.y << " " << p.z;
  }
  // Below the grid, but its light is half a cell above it.
  EXPECT_FALSE(all_zero(light_of(*basis, one_texel({0, -2.1f, 0}, {0, 1, 0}, glm::vec3(1)))));
  EXPECT_TRUE(all_zero(geometry_of(*basis, {one_texel({0, 2.3f, 0}, {0, 1, 0}, glm::vec3(1))})));
  // The outermost corners are half a cell's reach beyond the cells.
  EXPECT_FALSE(all_zero(geometry_of(*basis, {one_texel({0, 2.2f, 0}, {0, 1, 0}, glm::vec3(1))})));
}

TEST(Inject, ValuesThatAreNotFiniteAreSkipped) {
  const auto basis = make_basis("sh2");
  SurfaceImage row = plane(from_above(6, 1, 0.1f), 0.3f);
  const float nan = std::numeric_limits<float>::quiet_NaN(),
              infinity = std::numeric_limits<float>::infinity();
  row.depth[0] = nan;
  row.depth[1] = infinity;
  row.normal[2].x = nan;
  row.normal[3] = glm::vec4(0);
  row.colour[4].y = infinity;
  EXPECT_NEAR(basis->energy(light_of(*basis, row).total(0)), 1, kRounding)
      << "the sixth texel's flux";
  const Injection blocked = geometry_of(*basis, {row});
  EXPECT_TRUE(std::all_of(blocked.values.begin(), blocked.values.end(),
                          [](float v) { return std::isfinite(v); }));
}

TEST(Inject, AWallThatFillsItsCellsBlocksThreeQuartersHeadOn) {
  const auto basis = make_basis("sh2");
  // Two metres square: from corner 2 to 6, each inner corner's square full of 8 x 8 texels. Layer 5
  // is at 0.5 m.
  const SurfaceImage wall = plane(from_above(32, 32, 1.0f / 16), 0.55f);
  const Injection blocked = geometry_of(*basis, {wall});
  for (const int x : {3, 4, 5}) {
    EXPECT_NEAR(basis->value(blocked.cell(0, x, 5, 4), {0, 1, 0}), 0.75, kRounding);
    EXPECT_NEAR(basis->value(blocked.cell(0, x, 5, 4), {0, -1, 0}), -0.25, kRounding);
  }
  EXPECT_NEAR(basis->value(blocked.cell(0, 2, 5, 4), {0, 1, 0}), 0.75 / 2, kRounding)
      << "half a square";
}

TEST(Inject, AreasAreTheCoveredShareOfEachFace) {
  const auto basis = make_basis("sh2");
  const InjectOptions areas{.blocking = Blocking::areas};
  const Injection wall = geometry_of(*basis, {plane(from_above(32, 32, 1.0f / 16), 0.55f)}, areas);
  for (const int x : {3, 4, 5})
    EXPECT_THAT(wall.cell(0, x, 5, 4),
                testing::Pointwise(testing::DoubleNear(kRounding), {0.0, 1.0, 0.0}));
  // Two surfaces that cross in a cell: each blocks what it covers.
  const glm::vec3 normal = glm::normalize(glm::vec3(1, 2, 2)),
                  other = glm::normalize(glm::vec3(4, 4, 2));
  const Injection crossed = geometry_of(
      *basis,
      {one_texel({0, 0, 0}, normal, glm::vec3(1)), one_texel({0, 0, 0}, other, glm::vec3(1))},
      areas);
  const double across = 0.01 * 0.01 / (kCell * kCell);
  EXPECT_THAT(crossed.cell(0, 4, 4, 4),
              testing::Pointwise(testing::DoubleNear(across * 1e-5), {across, across, across}));
}

TEST(Inject, SlantedSurfelsCoverMoreUpToALimit) {
  const auto basis = make_basis("sh2");
  const auto mean = [&](double cosine) {
    const glm::vec3 normal(std::sqrt(1 - cosine * cosine), cosine, 0);
    const Injection blocked = geometry_of(*basis, {one_texel({0, 0, 0}, normal, glm::vec3(1))});
    return basis->energy(blocked.cell(0, 4, 4, 4)) / (4 * kPi);
  };
  const double across = 0.01 * 0.01 / (kCell * kCell);  // share of a cell, in the view's plane
  EXPECT_NEAR(mean(1.0), across / 4, across * 1e-5);
  EXPECT_NEAR(mean(0.5), across / 2, across * 1e-5);
  EXPECT_NEAR(mean(0.01), across / 0.1 / 4, across * 1e-4);
}

TEST(Inject, SurfacesThatSeeTheSameWallDoNotAddUp) {
  const auto basis = make_basis("sh2");
  ClpvView camera = from_above(200, 200, 1);
  camera.orthographic = 0, camera.eye[1] = 3.1f, camera.half_width = camera.half_height = 1;
  const SurfaceImage rsm = plane(from_above(64, 64, 1.0f / 16), 0.1f), seen = plane(camera, 0.1f);
  const Injection by_rsm = geometry_of(*basis, {rsm}), by_camera = geometry_of(*basis, {seen});
  const Injection merged = geometry_of(*basis, {rsm, seen});
  int larger_by_rsm = 0, larger_by_camera = 0;
  for (int x = 0; x <= kGrid; ++x) {
    for (int z = 0; z <= kGrid; ++z) {
      const auto one = by_rsm.cell(0, x, 4, z), other = by_camera.cell(0, x, 4, z);
      const bool camera_wins = basis->energy(other) > basis->energy(one);
      EXPECT_EQ(merged.cell(0, x, 4, z), camera_wins ? other : one);
      ++(camera_wins ? larger_by_camera : larger_by_rsm);
    }
  }
  EXPECT_GT(larger_by_rsm, 0);
  EXPECT_GT(larger_by_camera, 0);
  EXPECT_EQ(merged.values, geometry_of(*basis, {seen, rsm}).values) << "in either order";
}

TEST(Inject, SeveralSurfacesAtOnceAreEachAsAlone) {
  const auto basis = make_basis("sh2");
  Session& session = test_session();
  const VolumeFormat format{};
  Injector injector(session, *basis, {.grid = kGrid, .format = format});
  SurfaceImage both = plane(from_above(20, 40, 0.1f), 0.3f);
  for (std::size_t i = 0; i < both.depth.size(); ++i) both.colour[i].x = static_cast<float>(i % 7);
  std::vector<Surface> halves(2, upload_surface(session, both));
  std::vector<ClpvGrid> grids(2, kCells);
  grids[1].cell = 2 * kCells.cell, halves[1].first = 20 * 20;
  const VolumeShape shape{kGrid, basis->size(), 3};
  auto volumes = Volume::array(session, 3, shape, "light", format);
  std::vector<Injector::Target> targets;
  for (int i : {0, 1}) {
    halves[i].view.height = 20;
    targets.push_back({halves[i], grids[i], volumes[2 - i]});
  }
  injector.inject_light(targets);
  for (const auto& [surface, grid, volume, cascade] : targets) {
    Volume alone(session, shape, "light", format);
    injector.inject_light(surface, grid, alone);
    EXPECT_EQ(volume.read(session), alone.read(session));
    EXPECT_GT(std::ranges::max(alone.read(session)), 0);
  }
  EXPECT_EQ(std::ranges::max(volumes[0].read(session)), 0);
}

// Segments are longer in larger surfaces: a smaller one may have more of them, and their sums once
// overran memory.
TEST(Inject, ASmallerSurfaceOfMoreSegmentsFollowsALargerOne) {
  const auto basis = make_basis("sh2");
  Session& session = test_session();
  const Surface larger = upload_surface(session, plane(from_above(725, 725, 0.02f), 0.3f)),
                smaller = upload_surface(session, plane(from_above(724, 724, 0.02f), 0.3f));
  Injector fresh(session, *basis, {.grid = kGrid}), used(session, *basis, {.grid = kGrid});
  const auto light = [&](Injector& injector, const Surface& surface) {
    Volume volume(session, {kGrid, basis->size(), 3}, "light");
    injector.inject_light(surface, kCells, volume);
    return volume.read(session);
  };
  const std::size_t before = session.device_bytes();
  light(used, larger);
  const std::size_t held = session.device_bytes() - before;
  const std::vector<float> found = light(used, smaller);
  EXPECT_GT(session.device_bytes() - before, held) << "the sums of more segments take more memory";
  EXPECT_EQ(found, light(fresh, smaller));
}

// Lobes that the propagation kernel computes from tables or in closed form.
TEST(RunTimeLobes, OfUnevenLambdasAreThoseOfTheReference) {
  const std::shared_ptr<const Basis> basis = make_basis_from_centres(
      "uneven", make_basis("srbf4")->centres(), std::vector<double>{0.2, 0.3, 0.3, 0.25});
  for (const LobeKind kind : {LobeKind::exact, LobeKind::rotate}) {
    const Transport transport =
        make_transport(TransportKind::sampled, *basis, {.kind = kind, .table_functions = true});
    const verify::Job job = verify::propagate_job(
        test_session(), verify::random_propagation(
                            basis, transport, {.grid = 5, .lobe_time = LobeTime::kernel}, false));
    job.run();
    EXPECT_TRUE(job.compare().passed()) << name_of(kind) << ": " << job.compare().place;
  }
}

// The sort by cell against the standard library's stable sort: every texel that has a cell once,
// cell by cell, each cell's in their own order.

using Keys = std::vector<cl_uint>;
using Entry = std::array<cl_uint, 2>;  // cell, texel

std::vector<Entry> sorted_here(const Keys& keys) {
  std::vector<Entry> entries;
  for (cl_uint texel = 0; texel < keys.size(); ++texel) {
    if (keys[texel] != CLPV_NO_CELL) entries.push_back({keys[texel], texel});
  }
  std::ranges::stable_sort(entries, {}, [](const Entry& entry) { return entry[0]; });
  return entries;
}

std::vector<Entry> sorted_there(CellSorter& sorter, const Keys& keys, std::size_t cells) {
  sorter.reserve(keys.size());
  test_session().write(sorter.keys(), keys);
  sorter.sort(keys.size(), cells);
  const cl_uint count = test_session().read<cl_uint>(sorter.count(), 1)[0];
  EXPECT_LE(count, keys.size());
  return test_session().read<Entry>(sorter.sorted(), std::min<std::size_t>(count, keys.size()));
}

void expect_sorted(const Keys& keys, std::size_t cells) {
  CellSorter sorter(test_session());
  EXPECT_EQ(sorted_there(sorter, keys, cells), sorted_here(keys))
      << keys.size() << " texels, " << cells;
}

/// Runs of up to `longest` neighbours in one cell, as surfaces have; one texel in eight has no
/// cell.
Keys in_runs(std::size_t texels, cl_uint cells, unsigned longest, unsigned seed = 1) {
  std::mt19937 random(seed);
  Keys keys;
  while (keys.size() < texels) {
    const cl_uint key = random() % 8 == 0 ? CLPV_NO_CELL : static_cast<cl_uint>(random()) % cells;
    keys.insert(keys.end(), 1 + random() % longest, key);
  }
  keys.resize(texels);
  return keys;
}

TEST(SortByCell, CellsOfNoOneAndManyTexels) {
  expect_sorted(Keys(1000, CLPV_NO_CELL), 512);
  expect_sorted({32767}, 32768);
  for (const std::size_t texels : {15u, 16u, 17u, 255u, 257u, 5000u})
    expect_sorted(Keys(texels, 4912), 4913);
  Keys each_its_own(4096);
  std::iota(each_its_own.rbegin(), each_its_own.rend(), 0);
  expect_sorted(each_its_own, 4096);
  // Odd and even numbers of bits, powers of two and their neighbours.
  for (const cl_uint cells : {2u, 3u, 64u, 125u, 729u, 32768u, 35937u, 2146689u}) {
    expect_sorted(in_runs(3000, cells, 1), cells);
    expect_sorted(in_runs(3000, cells, 70), cells);
    expect_sorted(in_runs(3000, std::min(cells, 5u), 20), cells);
  }
}

// More texels than 512 chunks of minimum length, so chunks grow; not a multiple of a run's length.
TEST(SortByCell, LargeSurfaces) {
  expect_sorted(in_runs(200'003, 4096, 40), 4096);
}

TEST(SortByCell, RejectsMoreTexelsThanRunsCanName) {
  CellSorter sorter(test_session());
  EXPECT_THROW(sorter.reserve((std::size_t{1} << 28) + 1), Error);
}

}  // namespace clpv::inject_test
