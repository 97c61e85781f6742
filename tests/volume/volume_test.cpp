// SPDX-License-Identifier: MIT
// Volumes in every layout and storage: writing and reading, accumulation, errors of the device, and
// work-items of one or eight cells.
#include "volume/volume.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <random>

#include "pipeline/steps/propagate.hpp"
#include "tests/support/error_of.hpp"
#include "tests/support/on_device.hpp"
#include "volume/accumulator.hpp"

namespace clpv::volume_test {
using test::test_session;

constexpr float kHalf = 1.0f / 2048;  // half a unit in the last place of 11 bits below 1

std::vector<float> random_values(const VolumeShape& shape) {
  std::mt19937 random(3);
  std::uniform_real_distribution<float> uniform(-1, 1);
  const int cells = shape.n * shape.n * shape.n;
  std::vector<float> values(static_cast<std::size_t>(cells * shape.coefficients * shape.channels));
  for (float& value : values) value = uniform(random);
  return values;
}

/// Formats this device has, the default one among them.
std::vector<VolumeFormat> formats(const VolumeShape& shape) {
  std::vector<VolumeFormat> found;
  for (const VolumeFormat& format : all_formats()) {
    if (!unsupported(test_session().device(), format, shape)) found.push_back(format);
  }
  return found;
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
      const float allowed = format.storage == Storage::float32 ? 0 : kHalf;
      EXPECT_THAT(found, ::testing::Pointwise(::testing::FloatNear(allowed), values));
      Volume copy(test_session(), shape, "copy", format);
      copy.copy_from(test_session(), volume);
      EXPECT_EQ(copy.read(test_session()), found);
      volume.clear(test_session());
      EXPECT_THAT(volume.read(test_session()), ::testing::Each(0.0f));
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
      sum->write(session, random_values(kShape));
      const std::vector<float> kept = sum->read(session);
      accumulator.add_to_cells(*sum, [](const Volume&) {});
      EXPECT_EQ(sum->read(session), kept) << "adding nothing";
      EXPECT_EQ(session.device_bytes() - before,
                format.layout == Layout::image
                    ? stored_bytes(Accumulator::cells_format(format), kShape)
                    : 0);
    }
  }
}

}  // namespace clpv::volume_test
