// SPDX-License-Identifier: MIT
// Volumes in every layout and storage: what is written is read back, what a device lacks is said, and every stage
// gives the same numbers whatever way its volumes lie in memory.
#include "volume/volume.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "pipeline/propagate.hpp"
#include "support/error.hpp"
#include "tests/support/on_device.hpp"
#include "volume/accumulator.hpp"

namespace clpv {
namespace {

using test::test_session;

constexpr double kHalf = 1.0 / 2048;  // half a unit in the last place of 11 bits, relative

std::vector<float> random_values(std::size_t count) {
  std::mt19937 random(3);
  std::uniform_real_distribution<float> uniform(-1, 1);
  std::vector<float> values(count);
  for (float& value : values) value = uniform(random);
  return values;
}

std::vector<float> random_values(const VolumeShape& shape) {
  const auto n = static_cast<std::size_t>(shape.n);
  return random_values(n * n * n * static_cast<std::size_t>(shape.coefficients * shape.channels));
}

/// Formats this device has, the default one among them.
std::vector<VolumeFormat> formats(const VolumeShape& shape) {
  std::vector<VolumeFormat> found;
  for (const VolumeFormat& format : all_formats()) {
    if (!unsupported(test_session().device(), format, shape)) found.push_back(format);
  }
  return found;
}

void expect_near(const std::vector<float>& found, const std::vector<float>& wanted, double allowed) {
  ASSERT_EQ(found.size(), wanted.size());
  double largest = 0;
  for (const float value : wanted) largest = std::max(largest, std::abs(static_cast<double>(value)));
  ASSERT_GT(largest, 0);
  for (std::size_t i = 0; i < found.size(); ++i) ASSERT_NEAR(found[i], wanted[i], allowed * largest) << i;
}

TEST(Volume, FormatsAreEveryLayoutInEveryStorage) {
  EXPECT_EQ(all_formats().size(), 8u);
  EXPECT_EQ(format_name({}), "soa/float");
}

TEST(Volume, ReadsBackWhatWasWritten) {
  // Coefficients that fill texels of four, and such that do not; blocks of eight samples, and one more.
  for (const VolumeShape& shape : {VolumeShape{17, 4, 3}, {33, 1, 1}, {8, 9, 3}, {5, 14, 1}, {1, 25, 3}}) {
    const std::vector<float> values = random_values(shape);
    for (const VolumeFormat& format : formats(shape)) {
      SCOPED_TRACE(format_name(format) + " n " + std::to_string(shape.n));
      Volume volume(test_session(), shape, "test", format);
      volume.write(test_session(), values);
      const std::vector<float> found = volume.read(test_session());
      if (format.storage == Storage::float32) {
        EXPECT_EQ(found, values);
      } else {
        expect_near(found, values, kHalf);
      }
      Volume copy(test_session(), shape, "copy", format);
      copy.copy_from(test_session(), volume);
      EXPECT_EQ(copy.read(test_session()), found);
      volume.clear(test_session());
      for (const float value : volume.read(test_session())) ASSERT_EQ(value, 0.0f);
    }
  }
}

TEST(Volume, NoTwoCoefficientsShareAPlace) {
  const VolumeShape shape{9, 5, 3};
  for (const VolumeFormat& format : all_formats()) {
    SCOPED_TRACE(format_name(format));
    std::vector<bool> taken(stored_numbers(format, shape), false);
    for (int at = 0; at < 9 * 9 * 9 * 5 * 3; ++at) {
      const std::size_t index =
          stored_index(format, shape, at / 3645, at / 729 % 5, at % 9, at / 9 % 9, at / 81 % 9);
      ASSERT_LT(index, taken.size());
      ASSERT_FALSE(taken[index]);
      taken[index] = true;
    }
  }
}

TEST(Volume, WhatADeviceLacksIsSaid) {
  Device device = test_session().device();
  const VolumeFormat image{Layout::image, Storage::float16};
  device.image3d_writes = false;
  EXPECT_EQ(unsupported(device, image).value_or(""), "no 3-D image writes (cl_khr_3d_image_writes)");
  EXPECT_FALSE(unsupported(device, VolumeFormat{}));
  device.images = false;
  EXPECT_EQ(unsupported(device, image).value_or(""), "no images");
  try {
    require_supported(device, image, {8, 4, 3});
    FAIL() << "nothing thrown";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ExitCode::device);
    EXPECT_NE(std::string(error.what()).find("unsupported: no images"), std::string::npos) << error.what();
  }
}

TEST(Volume, AnImageThatIsTooLargeIsUnsupported) {
  const Device& device = test_session().device();
  if (unsupported(device, {Layout::image})) GTEST_SKIP() << "no 3-D images to write on " << device.name;
  EXPECT_TRUE(unsupported(device, {Layout::image}, {1 << 20, 4, 3}).has_value());
  EXPECT_FALSE(unsupported(device, {Layout::image}, {16, 4, 3}).has_value());
}

TEST(Volume, BuffersBeyondWhatKernelsAddressAreUnsupported) {
  EXPECT_TRUE(unsupported(test_session().device(), {}, {512, 25, 3}).has_value());
  EXPECT_FALSE(unsupported(test_session().device(), {}, {128, 25, 3}).has_value());
}

TEST(Volume, CountsWhatACellTakes) {
  EXPECT_EQ(accesses_per_cell({}, 9), 9);
  EXPECT_EQ(accesses_per_cell({Layout::image}, 9), 3);
  EXPECT_EQ(bytes_per_cell({Layout::tiled, Storage::float16}, 9), 18u);
  EXPECT_EQ(bytes_per_cell({Layout::image, Storage::float16}, 9), 24u);
}

TEST(Volume, PlanesBesideAnImageHoldTheSame) {
  const VolumeShape shape{9, 5, 3};
  for (const Storage storage : {Storage::float32, Storage::float16}) {
    if (unsupported(test_session().device(), {Layout::image, storage}, shape)) GTEST_SKIP() << "no images";
    Volume image(test_session(), shape, "image", {Layout::image, storage});
    image.write(test_session(), random_values(shape));
    PlaneStage stage(test_session(), shape, storage);
    stage.take(image);
    EXPECT_EQ(stage.planes().read(test_session()), image.read(test_session()));
    stage.planes().write(test_session(), std::vector<float>(random_values(shape).size(), 0.25f));
    stage.give(image);
    EXPECT_EQ(stage.planes().read(test_session()), image.read(test_session()));
  }
}

struct Run {
  VolumeFormat format = {};
  int grid = 5;
  int lanes = 0;
  State state = State::coefficients;
  bool blockers = false;
  std::string basis = "sh2";
  Blocking blocking = Blocking::one_sided;
};

/// What propagation makes of light and blockers, in one format.
std::vector<float> propagated(const Run& run, int iterations) {
  const auto basis = make_basis(run.basis);
  const Transport transport = make_transport(TransportKind::sampled, *basis, {}, run.blocking);
  const VolumeShape shape{run.grid, basis->size(), 3},
      corners{run.grid + 1, blocking_size(run.blocking, *basis), 1};
  Volume injected(test_session(), shape, "injected", run.format),
      accumulated(test_session(), shape, "sum", run.format),
      geometry(test_session(), corners, "geometry", run.format);
  injected.write(test_session(), random_values(shape));
  geometry.write(test_session(), random_values(corners));
  Propagator propagator(test_session(), *basis, transport,
                        {.grid = run.grid, .state = run.state, .format = run.format, .lanes = run.lanes});
  // Twice: nothing may be left of the first.
  for (int repetition = 0; repetition < 2; ++repetition) {
    propagator.propagate({injected, run.blockers ? &geometry : nullptr, accumulated}, iterations);
  }
  return accumulated.read(test_session());
}

/// Rows of whole blocks of eight and one cell more; checks of the stage have other grids.
TEST(VolumeLayouts, PropagationIsTheSameInAll) {
  constexpr int kGrid = 33;
  const std::vector<float> wanted = propagated({.grid = kGrid}, 3);
  for (const VolumeFormat& format : formats({kGrid, 4, 3})) {
    if (format == VolumeFormat{}) continue;
    SCOPED_TRACE(format_name(format));
    expect_near(propagated({.format = format, .grid = kGrid}, 3), wanted,
                format.storage == Storage::float16 ? 4e-3 : 2e-6);
  }
}

TEST(VolumeLayouts, OneCellAWorkItemOrEight) {
  for (const Layout layout : {Layout::soa, Layout::aos, Layout::tiled}) {
    SCOPED_TRACE(name_of(layout));
    const VolumeFormat format{layout, Storage::float32};
    const std::vector<float> one = propagated({.format = format, .grid = 9, .lanes = 1, .blockers = true}, 2);
    const std::vector<float> eight =
        propagated({.format = format, .grid = 9, .lanes = 8, .blockers = true}, 2);
    expect_near(eight, one, 2e-6);
  }
}

/// soa's planes lie an odd number of halves apart, and rows of eight are stored at any. (PoCL 3.1's own vstore_half8 crashed
/// just here, where sh3 takes more registers than there are.)
TEST(VolumeLayouts, RowsOfHalvesBeginAtAnyAddress) {
  const VolumeFormat format{Layout::soa, Storage::float16};
  const auto run = [&](int lanes) {
    return propagated({.format = format,
                       .grid = 24,
                       .lanes = lanes,
                       .blockers = true,
                       .basis = "sh3",
                       .blocking = Blocking::areas},
                      2);
  };
  expect_near(run(8), run(1), 4e-3);
}

/// Images take turns with spare ones: however many steps there are, the sums end where they should.
TEST(VolumeLayouts, ImagesAddUpOverAnyNumberOfSteps) {
  const VolumeFormat image{Layout::image, Storage::float32};
  if (unsupported(test_session().device(), image)) GTEST_SKIP() << "no 3-D images to write";
  for (const State state : {State::coefficients, State::fluxes}) {
    for (int iterations = 0; iterations <= 5; ++iterations) {
      SCOPED_TRACE(std::to_string(iterations) + " steps");
      expect_near(propagated({.format = image, .state = state, .blockers = true}, iterations),
                  propagated({.state = state, .blockers = true}, iterations), 2e-6);
    }
  }
}

}  // namespace
}  // namespace clpv
