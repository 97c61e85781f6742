// SPDX-License-Identifier: MIT
// References are traced once, and anew when anything they depend on changes or their file is damaged.
#include "quality/cached_reference.hpp"

#include <gtest/gtest.h>

#include <filesystem>

#include "tests/support/error_of.hpp"
#include "tests/support/scene_builder.hpp"
#include "tests/support/temporary_folder.hpp"

namespace clpv::cached_reference_test {
namespace {

namespace fs = std::filesystem;
using reference::cached_reference;
using reference::PathTracerOptions;
using reference::Reference;

class CachedReference : public ::testing::Test {
 protected:
  void SetUp() override {
    const unsigned white = test::add_material(scene_, glm::vec3(0.8f));
    test::add_quad(scene_, {-2, -1, -4}, {4, 0, 0}, {0, 2, 0}, white);
    test::add_quad(scene_, {-2, -1, 0}, {4, 0, 0}, {0, 0, -4}, white);
    scene_.name = "room/1";
    scene_.path = "room";
    scene_.lights = {{"sun", test::directional_light({0.2f, -1, -0.5f})}};
    camera_.name = "front";
    options_.samples = 4;
  }

  Reference get(int width = 12) const {
    return cached_reference(folder_, scene_, camera_, width, 8, options_);
  }

  test::TemporaryFolder temporary_;
  const fs::path folder_ = temporary_ / "references";
  Scene scene_;
  Camera camera_;
  PathTracerOptions options_;
};

TEST_F(CachedReference, IsTracedOnce) {
  const Reference first = get(), second = get();
  EXPECT_TRUE(first.traced);
  EXPECT_FALSE(second.traced);
  EXPECT_EQ(first.image.channels.size(), 28u) << "seven views of RGBA";
  EXPECT_EQ(first.samples, second.samples);
  EXPECT_EQ(first.noise, second.noise);
  for (const char* view : {"full", "indirect", "depth"}) {
    EXPECT_EQ(extract_layer(first.image, view, "a").pixels, extract_layer(second.image, view, "b").pixels)
        << view;
  }
  EXPECT_EQ(first.file.parent_path(), folder_) << "a slash in a scene's name leads nowhere";
}

TEST_F(CachedReference, DependsOnAllThatShapesIt) {
  get();
  EXPECT_TRUE(get(13).traced);
  camera_.eye.x += 0.01f;
  EXPECT_TRUE(get().traced);
  options_.seed = 2;
  EXPECT_TRUE(get().traced);
  options_.samples = 5;
  EXPECT_TRUE(get().traced);
  options_.bounces = PathTracerOptions::kAllBounces;
  EXPECT_TRUE(get().traced);
  scene_.lights[0].data.intensity[1] = 2;
  EXPECT_TRUE(get().traced);
  scene_.materials[0].base_colour[0] = 0.5f;
  EXPECT_TRUE(get().traced);
  scene_.vertices[3].position[2] -= 0.5f;
  EXPECT_TRUE(get().traced);
  options_.threads = 1;
  scene_.path = "elsewhere";
  EXPECT_FALSE(get().traced) << "neither of these changes the image";
}

TEST_F(CachedReference, DamagedFilesAreTracedAnew) {
  const fs::path file = get().file;
  fs::resize_file(file, fs::file_size(file) / 2);
  const Reference again = get();
  EXPECT_TRUE(again.traced);
  EXPECT_EQ(again.file, file);
  EXPECT_FALSE(get().traced);
}

TEST_F(CachedReference, AFolderThatCannotBeIsToldBeforeTracing) {
  temporary_.write("references", "a file where the folder should be");
  test::error_of(ExitCode::run_time, [&] { get(); });
}

}  // namespace
}  // namespace clpv::cached_reference_test
