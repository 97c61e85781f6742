// SPDX-License-Identifier: MIT
// EXR and PNG of a build without OpenImageIO, read by OpenImageIO and by that build.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <glm/vec3.hpp>
#include <string>
#include <utility>

#include "image/codec.hpp"
#include "image/image_io.hpp"
#include "tests/support/error_of.hpp"

namespace clpv::plain_codec_test {

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
  std::vector<unsigned char> cut;
  ASSERT_EQ(plain_codec().encode_exr(described(4, 3, {"R"}), image.pixels.data(), cut), "");
  cut.resize(cut.size() - 3 * (8 + 16) - 1);  // without the rows and the end of their table
  for (const auto& [format, bytes, reason] :
       {std::tuple{"webp", damaged, "without OpenImageIO (CLPV_IMAGES=OFF)"},
        {"openexr", exr_bytes(image), "without OpenImageIO (CLPV_IMAGES=OFF)"},
        {"openexr", cut, "no table of rows"},
        {"png", damaged, "unknown image type"}}) {
    std::string error;
    EXPECT_EQ(plain_codec().open(format, "a", bytes, error), nullptr);
    EXPECT_NE(error.find(reason), std::string::npos) << format << ": " << error;
  }
}

// Radiance pictures: orientations, exposures, primaries and encodings; what cannot be honoured is
// rejected by name.

using ::testing::HasSubstr;
using namespace std::string_literals;

std::string rejection(const std::string& bytes) {
  return test::error_of(ExitCode::bad_input, [&] { decode_image("a.hdr", bytes); });
}

// The image that each file shows: 1 2 3 4 above 5 6 7 8.
constexpr int kWidth = 4, kHeight = 2;

float shown(int x, int y) {
  return static_cast<float>(1 + x + kWidth * y);
}

std::string rgbe(float value) {
  int exponent = 0;
  const auto mantissa = static_cast<char>(std::frexp(value, &exponent) * 256);
  return std::string(3, mantissa) + static_cast<char>(exponent + 128);
}

struct Orientation {
  const char* resolution;
  bool columns = false, from_right = false, from_bottom = false;
};

std::string hdr(const std::string& lines, const Orientation& way = {"-Y 2 +X 4"},
                const std::string& end = "\n") {
  std::string bytes = "#?RADIANCE" + end + lines + end + way.resolution + end;
  const int slow = way.columns ? kWidth : kHeight, fast = way.columns ? kHeight : kWidth;
  for (int i = 0; i < slow; ++i) {
    for (int k = 0; k < fast; ++k) {
      const int x = way.columns ? i : k, y = way.columns ? k : i;
      bytes +=
          rgbe(shown(way.from_right ? kWidth - 1 - x : x, way.from_bottom ? kHeight - 1 - y : y));
    }
  }
  return bytes;
}

const std::string kRgbe = "FORMAT=32-bit_rle_rgbe\n";

void expect_shown(const Image& image, const glm::vec3& factor = glm::vec3(1)) {
  ASSERT_EQ(image.width, kWidth);
  ASSERT_EQ(image.height, kHeight);
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) {
      for (int c = 0; c < 3; ++c)
        EXPECT_FLOAT_EQ(image.at(x, y, static_cast<std::size_t>(c)), shown(x, y) * factor[c])
            << x << ' ' << y;
    }
  }
}

TEST(RadiancePictures, AreUprightWhateverTheirOrientation) {
  for (const Orientation& way : {Orientation{"-Y 2 +X 4"},
                                 {"+Y 2 +X 4", false, false, true},
                                 {"-Y 2 -X 4", false, true, false},
                                 {"+Y 2 -X 4", false, true, true},
                                 {"+X 4 -Y 2", true, false, false},
                                 {"+X 4 +Y 2", true, false, true},
                                 {"-X 4 -Y 2", true, true, false},
                                 {"-X 4 +Y 2", true, true, true}}) {
    SCOPED_TRACE(way.resolution);
    expect_shown(decode_image("a.hdr", hdr(kRgbe, way)));
  }
}

TEST(RadiancePictures, ExposuresAndColourCorrectionsAreDividedOut) {
  expect_shown(decode_image("a.hdr", hdr(kRgbe + "EXPOSURE=2\n")), glm::vec3(0.5f));
  expect_shown(decode_image("a.hdr", hdr(kRgbe + "EXPOSURE= 2.0\nEXPOSURE=4\n")),
               glm::vec3(0.125f));
  expect_shown(decode_image("a.hdr", hdr(kRgbe + "COLORCORR= 2 1 .5\n")), {0.5f, 1, 2});
  expect_shown(
      decode_image("a.hdr", hdr(kRgbe + "COLORCORR= 2 1 .5\nEXPOSURE=2\nCOLORCORR=2 1 1\n")),
      {0.125f, 0.5f, 1});
}

TEST(RadiancePictures, OtherLinesSayNothingOfTheValues) {
  expect_shown(
      decode_image("a.hdr", hdr(kRgbe + "# a comment\noconv x.rad\n\tEXPOSURE=2\nVIEW= -vtv\n"
                                        "PIXASPECT=1\nGAMMA=1\n")));
  expect_shown(decode_image("a.hdr", hdr("SOFTWARE=none\n")));
  expect_shown(decode_image("a.hdr", hdr("FORMAT=32-bit_rle_rgbe\r\n", {"-Y 2 +X 4"}, "\r\n")));
  std::string other = hdr(kRgbe);
  expect_shown(decode_image("a.hdr", other.replace(0, 10, "#?RGBE")));
}

TEST(RadiancePictures, PrimariesAreThoseOfRec709) {
  const std::string lines = kRgbe + "PRIMARIES= .708 .292 .17 .797 .131 .046 .3127 .329\n";
  const Image image = decode_image("a.hdr", hdr(lines));
  EXPECT_NEAR(image.at(2, 0, 0), 3, 1e-4) << "grey stays grey";
  EXPECT_EQ(image.notes.size(), 1u);
}

TEST(RadiancePictures, ScanlinesOfRunsOldAndNew) {
  const std::string head = "#?RADIANCE\n" + kRgbe + "\n-Y 1 +X 10\n";
  // Each byte of the pixels: a run of 7 times 128, then 3 literal ones.
  std::string runs = "\2\2\0\12"s;
  for (int channel = 0; channel < 4; ++channel)
    runs += "\x87\x80\3"s + (channel == 3 ? "\x81\x82\x83"s : "\x80\x80\x80"s);
  const Image packed = decode_image("a.hdr", head + runs);
  EXPECT_EQ(packed.at(6, 0, 0), 0.5f);
  EXPECT_EQ(packed.at(9, 0, 2), 4.0f);
  const Image old = decode_image("a.hdr", head + "\x80\x80\x80\x81"s + "\1\1\1\11"s);
  EXPECT_EQ(old.at(0, 0, 0), 1.0f);
  EXPECT_EQ(old.at(9, 0, 1), 1.0f);
  for (const std::string& bad :
       {"\2\2\0\11"s + runs.substr(4), "\2\2\0\12\x8b\x80"s + runs, "\2\2\0\12\13"s + runs,
        "\1\1\1\12"s, "\x80\x80\x80\x81\1\1\1\12"s, runs.substr(0, runs.size() - 1)})
    EXPECT_THAT(rejection(head + bad), HasSubstr("a.hdr: damaged or truncated"));
}

TEST(RadiancePictures, LinesThatCannotBeHonouredAreRejected) {
  for (const auto& [lines, word] :
       {std::pair("FORMAT=32-bit_rle_xyze\n", "FORMAT: found '32-bit_rle_xyze'"),
        {"EXPOSURE=0\n", "EXPOSURE: found '0'"},
        {"EXPOSURE=1e300\nEXPOSURE=1e300\n", "EXPOSURE: found '1e300'"},
        {"COLORCORR=1 2\n", "COLORCORR: found '1 2'; allowed: 3 numbers"},
        {"GAMMA=2.2\n", "GAMMA: found '2.2'; allowed: 1"},
        {"PRIMARIES=0 0 0 0 0 0 0 0\n", "three colours and a white"}})
    EXPECT_THAT(rejection(hdr(lines)), HasSubstr(word));
  for (const char* resolution :
       {"-Y 2 +Y 4", "-Y 2 X 4", "-Y 2 +X 4 5", "-Y 2", "Y 2 +X 4", "-Z 2 +X 4", "-Y 0x2 +X 4"})
    EXPECT_THAT(rejection(hdr(kRgbe, {resolution})),
                HasSubstr("resolution: found '" + std::string(resolution)));
}

}  // namespace clpv::plain_codec_test
