// SPDX-License-Identifier: MIT
// Headers of PNG and JPEG files, and the chunks of a PNG that are passed on to the decoder.
#include "image/image_header.hpp"

#include <gtest/gtest.h>

#include <string>

#include "image/image_io.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/support/tiny_images.hpp"

namespace clpv::image_header_test {
namespace {

std::span<const std::uint8_t> bytes_in(const std::string& text) {
  return {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()};
}

std::string bare(const std::string& png) {
  const auto kept = strip_png(bytes_in(png));
  return {kept.begin(), kept.end()};
}

/// A chunk whose checksum is 0, which decoders of the chunks that matter would reject.
std::string chunk(const std::string& type, const std::string& bytes) {
  const auto length = static_cast<char>(bytes.size());
  return std::string(3, '\0') + length + type + bytes + std::string(4, '\0');
}

constexpr std::size_t kHeaderEnd = 33;  // end of the signature and IHDR

const std::string_view kWebps[] = {test::kWebpRgba2x2, test::kWebpLossy, test::kWebpLossyAlpha};

TEST(ImageHeader, ReturnsSizes) {
  for (const auto& [encoded, format, side] : {std::tuple{test::kPngRgba2x2, ImageFormat::png, 2u},
                                              {test::kJpegRed8x8, ImageFormat::jpeg, 8u},
                                              {kWebps[0], ImageFormat::webp, 2u},
                                              {kWebps[1], ImageFormat::webp, 4u},
                                              {kWebps[2], ImageFormat::webp, 4u}}) {
    const auto header = read_image_header(bytes_in(test::decode_base64(encoded)));
    ASSERT_TRUE(header);
    EXPECT_EQ(header->format, format);
    EXPECT_EQ(header->width, side);
    EXPECT_EQ(header->height, side);
    EXPECT_TRUE(header->complete);
  }
  EXPECT_FALSE(read_image_header(bytes_in("no image")));
}

TEST(ImageHeader, APngThatIsCutIsNotComplete) {
  const std::string png = test::decode_base64(test::kPngRgba2x2);
  for (std::size_t length = kHeaderEnd; length < png.size(); ++length) {
    const auto header = read_image_header(bytes_in(png.substr(0, length)));
    ASSERT_TRUE(header) << length;
    EXPECT_FALSE(header->complete) << length;
  }
  EXPECT_TRUE(read_image_header(bytes_in(png + "and more"))->complete);
}

TEST(ImageHeader, APngWithAChunkLongerThanItselfIsNotComplete) {
  const std::string png = test::decode_base64(test::kPngRgba2x2);
  for (const std::string length : {"\x7f\xff\xff\xff", "\xff\xff\xff\xff", "\xff\xff\xff\xf4"}) {
    std::string bytes = png;
    bytes.insert(kHeaderEnd, length + "tEXtdata....");
    EXPECT_FALSE(read_image_header(bytes_in(bytes))->complete);
  }
}

TEST(ImageHeader, APngIsLeftWithWhatItsPixelsNeedAndPlainTexts) {
  const std::string png = test::decode_base64(test::kPngRgba2x2),
                    text = chunk("tEXt", "clpv:basis sh2");
  std::string more = png, kept = png;
  more.insert(kHeaderEnd, chunk("zTXt", "packed") + text + chunk("iCCP", "packed") +
                              chunk("iTXt", "") + chunk("eXIf", "?"));
  kept.insert(kHeaderEnd, text);
  EXPECT_EQ(bare(more), kept);
  EXPECT_EQ(bare(png + "after its end"), png);
  for (const std::string_view each : {test::kPngGrey, test::kPngGrey16, test::kPngPalette}) {
    const std::string whole = test::decode_base64(each);
    EXPECT_EQ(bare(whole), whole);
  }
}

TEST(ImageHeader, AWebpThatIsCutIsNotComplete) {
  for (const std::string_view each : kWebps) {
    const std::string webp = test::decode_base64(each);
    for (std::size_t length = 0; length + 1 < webp.size(); ++length) {
      const auto header = read_image_header(bytes_in(webp.substr(0, length)));
      EXPECT_FALSE(header && header->complete) << length;
    }
  }
}

TEST(ImageHeader, AnAnimatedWebpIsNone) {
  std::string webp = test::decode_base64(test::kWebpLossy);
  for (const char* chunk : {"ANIM", "ANMF"}) {
    webp.replace(12, 4, chunk);  // in place of the image
    EXPECT_FALSE(read_image_header(bytes_in(webp)));
  }
}

TEST(ImageHeader, AWebpIsLeftWithWhatItsPixelsNeed) {
  const auto stripped = [](const std::string& webp, bool alpha) {
    const auto kept = strip_webp(bytes_in(webp), alpha);
    return std::string(kept.begin(), kept.end());
  };
  for (const std::string_view each : kWebps) {
    const std::string webp = test::decode_base64(each);
    EXPECT_EQ(stripped(webp, true), webp);
  }
  std::string more = test::decode_base64(test::kWebpLossyAlpha);
  const std::string plain = more;
  more.insert(30, std::string("ICCP\3\0\0\0abc\0", 12));  // after VP8X; of odd length
  more += std::string("EXIF\2\0\0\0ab", 10);
  EXPECT_EQ(stripped(more, true), plain);
  EXPECT_EQ(stripped(more, false), test::decode_base64(test::kWebpLossy)) << "opaque";
}

}  // namespace
}  // namespace clpv::image_header_test
