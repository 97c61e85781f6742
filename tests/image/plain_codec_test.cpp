// SPDX-License-Identifier: MIT
// EXR and PNG of a build without OpenImageIO, read by OpenImageIO and by that build.
#include <gtest/gtest.h>

#include <utility>

#include "image/codec.hpp"
#include "image/image_io.hpp"

namespace clpv::plain_codec_test {
namespace {

std::string_view text_of(const std::vector<unsigned char>& bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

/// The image as a build without OpenImageIO decodes it. Fails the test with the reason.
Image plain(const std::string& format, std::span<const std::uint8_t> bytes) {
  std::string error;
  const auto decoder = open_plain(format, bytes, error);
  EXPECT_EQ(error, "");
  if (!decoder) return {};
  const CodedImage& coded = decoder->described();
  Image image = make_image(coded.width, coded.height, coded.channels);
  image.metadata = coded.metadata;
  EXPECT_EQ(decoder->read(image.pixels.data()), "");
  return image;
}

CodedImage described(int width, int height, std::vector<std::string> channels) {
  return {.width = width,
          .height = height,
          .channels = std::move(channels),
          .metadata = {{"scene", "cornell.json"}, {"options", R"({"grid":32})"}}};
}

TEST(PlainCodec, WritesExrThatOthersRead) {
  const std::string long_name = std::string(40, 'l') + ".R";
  for (const auto& channels :
       {std::vector<std::string>{"R", "G", "B"}, {"indirect.R", "depth.Z", "A", "R", long_name}}) {
    const CodedImage coded = described(37, 5, channels);
    std::vector<float> pixels(std::size_t{37} * 5 * channels.size());
    for (std::size_t i = 0; i < pixels.size(); ++i) pixels[i] = 0.37f * static_cast<float>(i * i);
    std::vector<unsigned char> bytes;
    ASSERT_EQ(plain_codec().encode_exr(coded, pixels.data(), bytes), "");
    const Image read = decode_image("plain.exr", text_of(bytes));
    ASSERT_EQ(read.pixels.size(), pixels.size());
    for (std::size_t c = 0; c < channels.size(); ++c) {
      const auto at = std::ranges::find(read.channels, channels[c]) - read.channels.begin();
      ASSERT_LT(at, std::ssize(read.channels)) << channels[c];
      for (std::size_t i = 0; i < pixels.size() / channels.size(); ++i)
        ASSERT_EQ(read.pixels[i * channels.size() + at], pixels[i * channels.size() + c]);
    }
    EXPECT_EQ(read.metadata, coded.metadata);
    const Image own = plain("openexr", bytes);
    EXPECT_EQ(own.metadata, coded.metadata);
    for (std::size_t c = 0; c < channels.size(); ++c) {
      const auto at = own.channel(read.channels[c]);
      ASSERT_TRUE(at) << read.channels[c];
      for (std::size_t p = 0; p < own.pixel_count(); ++p)
        ASSERT_EQ(own.pixels[p * channels.size() + *at], read.pixels[p * channels.size() + c]);
    }
  }
}

TEST(PlainCodec, WritesPngThatOthersRead) {
  for (const auto& channels : {std::vector<std::string>{"R", "G", "B"}, {"R", "G", "B", "A"}}) {
    const CodedImage coded = described(211, 173, channels);  // more than a stored block
    std::vector<std::uint8_t> pixels(std::size_t{211} * 173 * channels.size());
    for (std::size_t i = 0; i < pixels.size(); ++i) pixels[i] = static_cast<std::uint8_t>(i * 7);
    std::vector<unsigned char> bytes;
    ASSERT_EQ(plain_codec().encode_png(coded, pixels.data(), bytes), "");
    const Image read = decode_image("plain.png", text_of(bytes));
    EXPECT_EQ(read.channels, channels);
    ASSERT_EQ(read.pixels.size(), pixels.size());
    for (std::size_t i = 0; i < pixels.size(); ++i) ASSERT_EQ(byte_of(read.pixels[i]), pixels[i]);
    EXPECT_EQ(read.metadata, coded.metadata);
    const Image own = plain("png", bytes), compressed = plain("png", png_bytes(read));
    EXPECT_EQ(own.metadata, coded.metadata);
    EXPECT_EQ(own.channels, channels);
    EXPECT_EQ(own.pixels, read.pixels);
    EXPECT_EQ(compressed.pixels, read.pixels);
  }
}

TEST(PlainCodec, NamesWhatItLacks) {
  const Image image = make_image(4, 3, {"R", "G", "B"});
  const std::vector<std::uint8_t> damaged{0x89, 'P', 'N', 'G'};
  for (const auto& [format, bytes, reason] :
       {std::tuple{"webp", damaged, "without OpenImageIO (CLPV_IMAGES=OFF)"},
        {"openexr", exr_bytes(image), "without OpenImageIO (CLPV_IMAGES=OFF)"},
        {"png", damaged, "unknown image type"}}) {
    std::string error;
    EXPECT_EQ(plain_codec().open(format, "a", bytes, error), nullptr);
    EXPECT_NE(error.find(reason), std::string::npos) << format << ": " << error;
  }
}

}  // namespace
}  // namespace clpv::plain_codec_test
