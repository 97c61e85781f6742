// SPDX-License-Identifier: MIT
// Late light carried from coarser cascades to finer ones: what it does to irradiance, held against mathematics; and the
// stage in a frame.
#include "pipeline/carry_late.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <filesystem>
#include <functional>
#include <vector>

#include "basis/transport.hpp"
#include "checks/check.hpp"
#include "pipeline/cascade.hpp"
#include "pipeline/frame.hpp"
#include "reference/carry_late.hpp"
#include "reference/gather.hpp"
#include "scene/load.hpp"
#include "support/error.hpp"
#include "tests/support/on_device.hpp"

namespace clpv {
namespace {

using namespace test;

constexpr int kGrid = 12;
constexpr double kEdge = 6;      // of the finest grid [m]
constexpr double kFloat = 2e-6;  // relative: a dozen roundings of float32

/// Finest first. In cells of either kind, the camera is in the second of two finer ones along x alone.
std::vector<ClpvGrid> grids(int count) {
  return cascade_grids({0.6f, 0.1f, -1.0f}, count, kEdge, kGrid);
}

/// Each coefficient of every cell and channel from its centre [m].
using Fill = std::function<double(int channel, int coefficient, const glm::dvec3& centre)>;

reference::Volume volume_of(const ClpvGrid& grid, int coefficients, const Fill& fill) {
  reference::Volume volume(kGrid, coefficients);
  for (int z = 0; z < kGrid; ++z) {
    for (int y = 0; y < kGrid; ++y) {
      for (int x = 0; x < kGrid; ++x) {
        const glm::dvec3 centre = glm::dvec3(grid.origin[0], grid.origin[1], grid.origin[2]) +
                                  double{grid.cell} * (glm::dvec3(x, y, z) + 0.5);
        for (int channel = 0; channel < 3; ++channel) {
          for (int i = 0; i < coefficients; ++i) volume.at(channel, i, x, y, z) = fill(channel, i, centre);
        }
      }
    }
  }
  return volume;
}

/// `sum` with `light` carried to it, by the kernel; the twin must say the same.
reference::Volume carried(const reference::Volume& light, const ClpvGrid& coarser,
                          const reference::Volume& sum, const ClpvGrid& finer,
                          const VolumeFormat& format = {}, int lanes = 0) {
  const VolumeShape shape{kGrid, sum.coefficients, 3};
  Volume from(test_session(), shape, "test: light", format), to(test_session(), shape, "test: sum", format);
  from.write(test_session(), {light.values.begin(), light.values.end()});
  to.write(test_session(), {sum.values.begin(), sum.values.end()});
  LateCarrier(test_session(), shape, format, lanes).carry(from, coarser, to, finer);
  const std::vector<float> found = to.read(test_session());
  reference::Volume twin = sum;
  reference::carry_late(light, coarser, twin, finer);
  double largest = 0;
  for (const double value : twin.values) largest = std::max(largest, std::abs(value));
  for (std::size_t at = 0; at < found.size(); ++at)
    EXPECT_NEAR(found[at], twin.values[at], kFloat * largest) << at;
  reference::Volume result = sum;
  result.values.assign(found.begin(), found.end());
  return result;
}

/// E of red on a surface amid the finest grid, lit by that cascade alone.
double irradiance(const Basis& basis, const Transport& transport, const ClpvGrid& grid,
                  const reference::Volume& light, const glm::dvec3& position, const glm::dvec3& normal) {
  return reference::gather(basis, GatherForm(basis, transport), {.grid = kGrid}, {{grid, &light}}, position,
                           normal)
      .x;
}

TEST(CarryLate, UniformLightGivesTheSameIrradianceFromTheFinerCascade) {
  const glm::dvec3 normal = glm::normalize(glm::dvec3(1, -2, 0.5)), position(0.3, 0.2, -0.9);
  for (const char* name : {"sh2", "srbf8v2"}) {
    const auto basis = make_basis(name);
    const std::vector<double> lobe = basis->clamped_cosine({0, 0.6, -0.8});
    const std::vector<ClpvGrid> two = grids(2);
    const auto light = volume_of(two[1], basis->size(), [&](int channel, int i, const glm::dvec3&) {
      return (channel + 1) *
             (lobe[static_cast<std::size_t>(i)] + basis->constant()[static_cast<std::size_t>(i)]);
    });
    const auto fine = carried(light, two[1], reference::Volume(kGrid, basis->size()), two[0]);
    for (const TransportKind of : {TransportKind::sampled, TransportKind::upwind}) {
      const Transport transport = make_transport(of, *basis);
      const double coarse = irradiance(*basis, transport, two[1], light, position, normal);
      ASSERT_GT(coarse, 0.1);
      EXPECT_NEAR(irradiance(*basis, transport, two[0], fine, position, normal), coarse, kFloat * coarse)
          << name << ' ' << name_of(of);
    }
  }
}

TEST(CarryLate, LinearLightIsReproducedAndAddedToWhatIsThere) {
  const std::vector<ClpvGrid> two = grids(2);
  const Fill linear = [](int channel, int i, const glm::dvec3& p) {
    return (channel + 1) * (20 + 3 * i + 0.3 * p.x - 0.7 * p.y + (1.1 + i) * p.z);
  };
  const auto before = volume_of(two[0], 5, [](int channel, int i, const glm::dvec3& p) {
    return channel - i + std::sin(p.x + 2 * p.y + 3 * p.z);
  });
  const auto light = volume_of(two[1], 5, linear);
  const auto field = volume_of(two[0], 5, linear);
  for (const VolumeFormat& format : all_formats()) {
    if (format.storage != Storage::float32 || unsupported(test_session().device(), format)) continue;
    for (const int lanes : {1, 8}) {
      if (lanes > most_lanes(format)) continue;
      SCOPED_TRACE(format_name(format) + " " + std::to_string(lanes));
      const auto after = carried(light, two[1], before, two[0], format, lanes);
      for (std::size_t at = 0; at < after.values.size(); ++at) {
        ASSERT_NEAR(after.values[at], before.values[at] + field.values[at] / 4, 100 * kFloat) << at;
      }
    }
  }
}

TEST(CarryLate, BeyondTheCoarserGridThereIsNothing) {
  std::vector<ClpvGrid> two = grids(2);
  const auto one = volume_of(two[1], 1, [](int, int, const glm::dvec3&) { return 4.0; });
  // The finer grid begins half a coarser cell before the coarser one: its first centres are a quarter of one outside
  // the first coarser centre's cell, where three quarters of the zero beyond weigh in.
  two[0].origin[0] = two[1].origin[0] - two[0].cell;
  const auto fine = carried(one, two[1], reference::Volume(kGrid, 1), two[0]);
  EXPECT_FLOAT_EQ(static_cast<float>(fine.value(0, 0, 0, 5, 5)), 0.25f);
  EXPECT_FLOAT_EQ(static_cast<float>(fine.value(0, 0, 1, 5, 5)), 0.75f);
  EXPECT_FLOAT_EQ(static_cast<float>(fine.value(0, 0, 2, 5, 5)), 1.0f);
}

TEST(CarryLate, RefusesGridsThatAreNotNested) {
  const VolumeShape shape{kGrid, 1, 3};
  Volume from(test_session(), shape, "test: light"), to(test_session(), shape, "test: sum");
  LateCarrier carrier(test_session(), shape, {});
  const std::vector<ClpvGrid> three = grids(3);
  EXPECT_THROW(carrier.carry(from, three[2], to, three[0]), Error);
  ClpvGrid aside = three[0];
  aside.origin[1] += 0.3f * aside.cell;
  EXPECT_THROW(carrier.carry(from, three[1], to, aside), Error);
  aside = three[0];
  aside.origin[2] += 100 * aside.cell;
  EXPECT_THROW(carrier.carry(from, three[1], to, aside), Error);
}

/// The frame's stage: cascades' names on the timeline, and irradiance with and without.
struct Lit {
  std::vector<int> carried_to;
  double irradiance = 0;  ///< mean over all pixels and channels
};

Lit lit(int cascades, bool late, Layout layout = Layout::soa) {
  const Scene scene = load_scene(std::filesystem::path(CLPV_SOURCE_DIR) / "scenes/cornell.json");
  RenderOptions options;
  options.width = 48, options.height = 27, options.grid = 16, options.iterations = 6;
  options.rsm_size = 64, options.shadow_size = 64, options.cascade_size = 1.5;
  options.cascades = cascades, options.late_light = late, options.layout = layout;
  options.basis = "bins24";  // nothing in it is negative: light can only be added
  Frame frame(test_session(), scene, options);
  Lit result;
  for (int run = 0; run < 2; ++run) {  // nothing may be left of the first
    test_session().timeline().clear();
    frame.render(scene.camera(""));
    const std::vector<float> pixels = frame.read(Show::irradiance);
    result = {};
    for (std::size_t i = 0; i < pixels.size(); ++i) result.irradiance += i % 4 == 3 ? 0.0 : pixels[i];
    for (const StageTime& time : test_session().timeline().times()) {
      if (time.mark.pass == Pass::carry_late) result.carried_to.push_back(time.mark.cascade.value());
    }
  }
  return result;
}

TEST(CarryLate, IsAStageOfEachFinerCascadeAndAddsLight) {
  const Lit with = lit(3, true), without = lit(3, false);
  EXPECT_EQ(with.carried_to, (std::vector<int>{1, 0}));
  EXPECT_TRUE(without.carried_to.empty());
  EXPECT_TRUE(lit(1, true).carried_to.empty()) << "one cascade has no coarser one";
  EXPECT_EQ(lit(1, true).irradiance, lit(1, false).irradiance);
  EXPECT_GT(with.irradiance, 1.01 * without.irradiance);
}

TEST(CarryLate, AFrameOfImagesIsLitAsOneOfBuffers) {
  if (unsupported(test_session().device(), {Layout::image, Storage::float32}))
    GTEST_SKIP() << "no 3-D images to write";
  const double wanted = lit(3, true).irradiance;
  EXPECT_NEAR(lit(3, true, Layout::image).irradiance, wanted, 1e-5 * wanted);
}

TEST(CarryLate, KernelAgreesWithItsTwin) {
  expect_passed(reference::check_carry_late(test_session()));
}

}  // namespace
}  // namespace clpv
