// SPDX-License-Identifier: MIT
// Textures in the rasteriser: mip chains, wrap modes, filters.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <utility>

#include "pipeline/raster/view.hpp"
#include "scene/mip_chain.hpp"
#include "tests/support/drawn.hpp"
#include "tests/support/scene_builder.hpp"

namespace clpv::texture_test {
Texture texture(std::uint32_t width, std::uint32_t height, std::vector<std::uint8_t> rgba) {
  Texture made;
  made.width = width;
  made.height = height;
  made.rgba = std::move(rgba);
  return made;
}

TEST(MipChain, EndsAtOneTexelWithTheMeanInLinearLight) {
  Texture checkered = texture(6, 5, {});
  for (int i = 0; i < 30; ++i) {
    const std::uint8_t v = i % 2 == 0 ? 0 : 255;
    checkered.rgba.insert(checkered.rgba.end(), {v, v, v, 255});
  }
  const std::vector<Texture> levels = mip_chain(checkered, false);
  ASSERT_EQ(levels.size(), 3u);  // 6 x 5, 3 x 2, 1 x 1
  EXPECT_EQ(levels[1].width, 3u);
  EXPECT_EQ(levels[1].height, 2u);
  EXPECT_EQ(levels[2].rgba,
            (std::vector<std::uint8_t>{188, 188, 188, 255}));  // mean 0.5; not 128, as by bytes
}

TEST(MipChain, OddSizesLoseNothing) {
  // One bright texel of 5: each level down must keep a fifth of the light, wherever it is.
  for (std::size_t bright = 0; bright < 5; ++bright) {
    Texture line = texture(5, 1, std::vector<std::uint8_t>(20, 0));
    line.rgba[4 * bright] = 255;
    const std::vector<Texture> levels = mip_chain(line, false);
    EXPECT_NEAR(linear_from_srgb(levels.back().rgba[0]), 0.2, 0.004) << bright;
  }
}

TEST(MipChain, HolesDoNotTintOpaqueTexels) {
  const Texture leaf = texture(2, 1, {200, 100, 50, 255, 0, 0, 255, 0});
  EXPECT_EQ(mip_chain(leaf, true)[1].rgba, (std::vector<std::uint8_t>{200, 100, 50, 128}));
  EXPECT_NE(mip_chain(leaf, false)[1].rgba[2], 50);
}

TEST(MipChain, EverySrgbByteComesBack) {
  for (unsigned byte = 0; byte < 256; ++byte)
    EXPECT_EQ(srgb_from_linear(linear_from_srgb(byte)), byte);
}

/// An orthographic camera looking down -z at the square (0..1)^2 at z = -1, whose uv runs from
/// `from` to `to`.
SurfaceImage image_of(SceneData scene, int size, const glm::vec2& from, const glm::vec2& to) {
  test::add_quad(scene, {0, 0, -1}, {1, 0, 0}, {0, 1, 0}, 0);
  for (Vertex& v : scene.vertices) {
    for (int i = 0; i < 2; ++i) v.uv[i] = from[i] + v.uv[i] * (to[i] - from[i]);
  }
  ClpvView view = camera_view(SceneCamera{}, size, size);
  view.eye[0] = view.eye[1] = 0.5f;
  view.orthographic = 1;
  view.half_width = view.half_height = 0.5f;
  return test::drawn(scene, view);
}

/// A scene with a textured white material and no triangles yet.
SceneData textured(Texture used, unsigned flags = 0) {
  SceneData scene;
  test::add_material(scene, glm::vec3(1), flags);
  scene.materials[0].texture = 0;
  scene.materials[0].alpha_cutoff = 0.5f;
  scene.textures.push_back(std::move(used));
  return scene;
}

/// Red 0, 255, 0, 255 along u.
Texture stripes(std::uint32_t wrap) {
  Texture made = texture(4, 1, {0, 0, 0, 255, 255, 0, 0, 255, 0, 0, 0, 255, 255, 0, 0, 255});
  made.wrap_u = made.wrap_v = wrap;
  return made;
}

std::vector<float> reds(const SurfaceImage& image) {  // in the top row
  std::vector<float> values;
  for (unsigned x = 0; x < image.view.width; ++x) values.push_back(image.colour[x].x);
  return values;
}

auto close(const std::vector<float>& values) {
  return ::testing::Pointwise(::testing::FloatNear(1e-5f), values);
}

TEST(Texture, TexelsOfEverySizeSitWhereTheyShould) {
  for (const auto& [width, height] :
       std::vector<std::pair<int, int>>{{1, 9}, {5, 3}, {4, 4}, {7, 8}, {13, 6}}) {
    Texture made = texture(width, height, {});
    for (int i = 0; i < width * height; ++i) {
      made.rgba.insert(made.rgba.end(), {static_cast<std::uint8_t>(37 * i), 0, 0, 255});
    }
    const std::vector<std::uint8_t> bytes = made.rgba;
    const int size = std::max(width, height);  // pixels; a texel each, repeated along one side
    const SurfaceImage image = image_of(textured(std::move(made)), size, {0, 0},
                                        {1.0f * size / width, 1.0f * size / height});
    for (int y = 0; y < size; ++y) {
      for (int x = 0; x < size; ++x) {
        const int texel = (size - 1 - y) % height * width + x % width;
        EXPECT_NEAR(image.colour[y * size + x].x, linear_from_srgb(bytes[4 * texel]), 1e-4)
            << width << " x " << height << ", pixel " << x << ", " << y;
      }
    }
  }
}

TEST(Texture, WrapModesRepeatMirrorAndClamp) {
  const auto from_minus_half = [&](std::uint32_t wrap) {  // texels -2 .. 5
    return reds(image_of(textured(stripes(wrap)), 8, {-0.5f, 0}, {1.5f, 1}));
  };
  EXPECT_THAT(from_minus_half(CLPV_WRAP_REPEAT), close({0, 1, 0, 1, 0, 1, 0, 1}));
  EXPECT_THAT(from_minus_half(CLPV_WRAP_MIRROR), close({1, 0, 0, 1, 0, 1, 1, 0}));
  EXPECT_THAT(from_minus_half(CLPV_WRAP_CLAMP), close({0, 0, 0, 1, 0, 1, 1, 1}));
}

TEST(Texture, SmallTexelsAreAveragedByMipLevels) {
  Texture fine = texture(64, 64, {});
  for (unsigned i = 0; i < 64 * 64; ++i) {
    const std::uint8_t v = (i + i / 64) % 2 == 0 ? 0 : 255;
    fine.rgba.insert(fine.rgba.end(), {v, v, v, 255});
  }
  for (const glm::vec4& colour : image_of(textured(fine), 8, {0, 0}, {1, 1}).colour)
    EXPECT_NEAR(colour.x, 0.5, 0.003);
  // A level and a half down a pixel takes the mean of both levels; here they are the same grey.
  for (const glm::vec4& colour : image_of(textured(fine), 23, {0, 0}, {1, 1}).colour)
    EXPECT_NEAR(colour.x, 0.5, 0.003);
}

}  // namespace clpv::texture_test
