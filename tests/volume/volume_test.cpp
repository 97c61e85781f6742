// SPDX-License-Identifier: MIT
// Volumes in every layout and storage: writing and reading, accumulation, errors of the device, and
// work-items of one or eight cells.
#include "volume/volume.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "pipeline/steps/propagate.hpp"
#include "tests/support/error_of.hpp"
#include "tests/support/on_device.hpp"
#include "volume/accumulator.hpp"

namespace clpv::volume_test {
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

void expect_near(const std::vector<float>& found, const std::vector<float>& wanted,
                 double allowed) {
  ASSERT_EQ(found.size(), wanted.size());
  double largest = 0;
  for (const float value : wanted)
    largest = std::max(largest, std::abs(static_cast<double>(value)));
  ASSERT_GT(largest, 0);
  for (std::size_t i = 0; i < found.size(); ++i)
    ASSERT_NEAR(found[i], wanted[i], allowed * largest) << i;
}

TEST(Volume, ReadsBackWhatWasWritten) {
  // Coefficients that fill texels of four, and such that do not; blocks of eight samples, and one
  // more.
  for (const VolumeShape& shape :
       {VolumeShape{17, 4, 3}, {33, 1, 1}, {8, 9, 3}, {5, 14, 1}, {1, 25, 3}}) {
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

TEST(Volume, MissingDeviceFeaturesAreReported) {
  Device device = test_session().device();
  const VolumeFormat image{Layout::image, Storage::float16};
  device.image3d_writes = false;
  EXPECT_EQ(unsupported(device, image).value_or(""),
            "no 3-D image writes (cl_khr_3d_image_writes)");
  EXPECT_FALSE(unsupported(device, VolumeFormat{}));
  device.images = false;
  EXPECT_EQ(unsupported(device, image).value_or(""), "no images");
  EXPECT_NE(test::error_of(ExitCode::device,
                           [&] {
                             require_supported(device, image, {8, 4, 3});
                           })
                .find("unsupported: no images"),
            std::string::npos);
}

TEST(Volume, BuffersBeyondWhatKernelsAddressAreUnsupported) {
  EXPECT_TRUE(unsupported(test_session().device(), {}, {512, 25, 3}).has_value());
  EXPECT_FALSE(unsupported(test_session().device(), {}, {128, 25, 3}).has_value());
}

constexpr VolumeShape kShape{5, 6, 3};

TEST(Accumulator, UsesTheReportedMemory) {
  Session& session = test_session();
  for (const VolumeFormat& format : formats(kShape)) {
    SCOPED_TRACE(format_name(format));
    Volume one(session, kShape, "one sum", format), other(session, kShape, "other sum", format);
    const std::size_t before = session.device_bytes();
    {
      Accumulator accumulator(session);
      for (Volume* sum : {&one, &other, &one}) {
        accumulator.add(*sum, [](const Volume&, const Volume&) {});
        EXPECT_EQ(session.device_bytes() - before,
                  format.layout == Layout::image ? one.bytes() : 0);
      }
    }
    EXPECT_EQ(session.device_bytes(), before) << "given back";
    Accumulator accumulator(session);
    for (Volume* sum : {&one, &other}) {
      accumulator.add_to_cells(*sum, [](const Volume&) {});
      EXPECT_EQ(session.device_bytes() - before,
                format.layout == Layout::image
                    ? stored_bytes(Accumulator::cells_format(format), kShape)
                    : 0);
    }
  }
}

}  // namespace
}  // namespace clpv::volume_test
