// SPDX-License-Identifier: MIT
// Hostile and broken images of a model, one a test.
#include "tests/support/bad_input.hpp"

namespace clpv::test::bad_image_test {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

struct BadImageTest : BadInputTest {};

TEST_F(BadImageTest, APngOf60000By60000) {
  std::string png = decode_base64(kPngRgba2x2);
  for (const std::size_t at : {16, 20}) png.replace(at, 4, std::string("\0\0\xea\x60", 4));
  folder.write("huge.png", png);
  wear("huge.png");
  EXPECT_THAT(refused(), AllOf(HasSubstr("/images/0"), HasSubstr("60000 x 60000"), HasSubstr("16384")));
}

TEST_F(BadImageTest, AJpegOf65500By65500) {
  std::string jpeg = decode_base64(kJpegRed8x8);
  const std::size_t frame = jpeg.find("\xff\xc0");
  ASSERT_NE(frame, std::string::npos);
  jpeg.replace(frame + 5, 4, "\xff\xdc\xff\xdc");
  folder.write("huge.jpg", jpeg);
  wear("huge.jpg");
  EXPECT_THAT(refused(), AllOf(HasSubstr("/images/0"), HasSubstr("65500 x 65500")));
}

TEST_F(BadImageTest, TexelsInAllAreBounded) {
  std::string png = decode_base64(kPngRgba2x2);
  for (const std::size_t at : {16, 20})
    png.replace(at, 4, std::string("\0\0\x40\0", 4));  // 16384: 1 GiB each
  folder.write("large.png", png);
  wear("large.png");
  model.document["images"].push_back({{"uri", "large.png"}});
  model.document["textures"].push_back({{"source", 1}});
  model.document["materials"].push_back({{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 1}}}}}});
  EXPECT_THAT(refused(),
              AllOf(HasSubstr("/images/1"), HasSubstr("bytes of texels"), HasSubstr("1073741824")));
}

TEST_F(BadImageTest, ImagesThatAreNone) {
  wear("image.png");
  folder.write("image.png", "#!/bin/sh\necho hello, this is no image at all\n");
  EXPECT_THAT(refused(), AllOf(HasSubstr("/images/0"), HasSubstr("'image.png'"), HasSubstr("23 21 2f 62"),
                               HasSubstr("PNG or JPEG")));
  folder.write("image.png", "");
  EXPECT_THAT(refused(), HasSubstr("/images/0"));
}

TEST_F(BadImageTest, TruncatedImagesAtAnyLength) {
  for (const std::string_view encoded : {kPngRgba2x2, kJpegRed8x8}) {
    const std::string image = decode_base64(encoded);
    const GltfBuilder sound = model;
    wear("image.png");
    for (std::size_t length = 0; length + 12 < image.size(); length += 7) {
      folder.write("image.png", image.substr(0, length));
      EXPECT_THAT(refused(), HasSubstr("/images/0")) << length;
    }
    model = sound;
  }
}

TEST_F(BadImageTest, ACorruptPng) {
  std::string png = decode_base64(kPngRgba2x2);
  for (std::size_t i = 43; i < 52; ++i) png[i] = '\x55';  // inside the compressed pixels
  folder.write("image.png", png);
  wear("image.png");
  EXPECT_THAT(refused(), AllOf(HasSubstr("/images/0"), HasSubstr("does not decode")));
}

TEST_F(BadImageTest, APngWithATextOf2GiB) {
  std::string png = decode_base64(kPngRgba2x2);
  png.insert(33, "\x7f\xff\xff\xffzTXtComment");
  folder.write("image.png", png);
  wear("image.png");
  EXPECT_THAT(refused(), AllOf(HasSubstr("/images/0"), HasSubstr("truncated")));
}

TEST_F(BadImageTest, ATextureWithoutASource) {
  wear("image.png");
  model.document["textures"][0] = {{"extensions", {{"KHR_texture_basisu", {{"source", 0}}}}}};
  EXPECT_THAT(refused(), AllOf(HasSubstr("/textures/0"), HasSubstr("no source")));
}

}  // namespace
}  // namespace clpv::test::bad_image_test
