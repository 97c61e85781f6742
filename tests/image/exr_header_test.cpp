// SPDX-License-Identifier: MIT
// Parser of EXR headers, on files that OpenEXR wrote and on headers built byte by byte.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <span>
#include <string>

#include "image/image_header.hpp"
#include "image/image_io.hpp"
#include "support/error.hpp"
#include "tests/support/gltf_builder.hpp"
#include "tests/support/run_here.hpp"
#include "tests/support/run_program.hpp"
#include "tests/support/tiny_images.hpp"

namespace clpv::exr_header_test {

using namespace std::string_literals;
using ::testing::AllOf;
using ::testing::HasSubstr;

std::vector<ExrHeader> parts_of(const std::string& bytes) {
  return read_exr_header(
      "a.exr", std::span(reinterpret_cast<const unsigned char*>(bytes.data()), bytes.size()));
}

ExrHeader walked(const std::string& bytes) {
  return parts_of(bytes).front();
}

std::string rejection(const std::string& bytes) {
  return test::error_of(ExitCode::bad_input, [&] { walked(bytes); });
}

void expect_accepted(const std::string& bytes) {
  EXPECT_NO_THROW(walked(bytes));
}

std::string number(std::uint32_t value) {
  return test::bytes_of<std::uint32_t>({value});
}

std::string attribute(const std::string& name, const std::string& type, const std::string& value) {
  return name + '\0' + type + '\0' + number(static_cast<std::uint32_t>(value.size())) + value;
}

std::string window(std::uint32_t x, std::uint32_t y) {
  return attribute("dataWindow", "box2i", test::bytes_of<std::uint32_t>({0, 0, x - 1, y - 1}));
}

std::string channel(const std::string& name) {
  return name + '\0' + test::bytes_of<std::uint32_t>({2, 0, 1, 1});
}

std::string part_type(const std::string& value) {
  return attribute("type", "string", value);
}

enum Flags : std::uint32_t { scan_lines = 0, tiled = 0x200, deep = 0x800, several = 0x1000 };

/// Headers, each with the NUL that ends it, and room for what follows them.
std::string file(Flags flags, const std::string& headers, std::size_t room = 8) {
  return "\x76\x2f\x31\x01" + number(2 | flags) + headers + std::string(room, '\0');
}

/// One part with these attributes in it.
std::string one(const std::string& attributes, std::size_t room = 8) {
  return file(scan_lines, attributes + '\0', room);
}

TEST(ExrHeader, TakesTilesAndDeepPartsByFlagsAndTypes) {
  const std::string size = window(64, 64),
                    tiles = attribute("tiles", "tiledesc", number(16) + number(8) + '\0');
  const std::string deep_type = part_type("deepscanline");
  EXPECT_FALSE(walked(one(size + tiles, 512)).tiled);
  const DeclaredImage declared = walked(file(tiled, size + tiles + '\0', 256));
  EXPECT_TRUE(declared.tiled);
  EXPECT_EQ(declared.chunk_width, 16);
  EXPECT_EQ(declared.chunk_height, 8);
  EXPECT_TRUE(walked(file(deep, size + deep_type + '\0', 512)).deep);
  EXPECT_FALSE(walked(one(size + deep_type, 512)).deep);
  EXPECT_TRUE(
      walked(file(several, size + tiles + part_type("tiledimage") + '\0' + '\0', 256)).tiled);
}

TEST(ExrHeader, PartsAreOfTypesThatOpenExrChecks) {
  for (const Flags flags : {deep, several}) {
    EXPECT_THAT(rejection(file(flags, part_type("scanlin") + '\0' + '\0')),
                HasSubstr("part 0: found type 'scanlin'; allowed: scanlineimage, tiledimage, "
                          "deepscanline, deeptile"));
    EXPECT_THAT(rejection(file(flags, window(4, 4) + '\0' + '\0')), HasSubstr("found type ''"));
  }
  expect_accepted(one(part_type("scanlin")));  // OpenEXR reads the flags
}

TEST(ExrHeader, TextsAndUnknownTypesAreNoLongerThanTheFile) {
  for (const std::string type : {"string", "bytes", "idmanifest", "of no name", "floatvector"}) {
    const std::string found = rejection(one("a\0"s + type + '\0' + number(1u << 30) + "text", 0));
    EXPECT_THAT(found, AllOf(HasSubstr("a.exr: part 0, attribute 'a' (" + type + ")"),
                             HasSubstr("1073741824"), HasSubstr("the 5 bytes left")));
  }
  EXPECT_THAT(rejection(one("a\0string\0"s + number(0xffffffffu))), HasSubstr("4294967295 bytes"));
  EXPECT_EQ(walked(one(attribute("a", "string", ""))).width, 0);
}

TEST(ExrHeader, ChannelsAreCountedAndHaveUniqueNames) {
  const auto channels = [](const std::string& list) {
    return one(attribute("channels", "chlist", list));
  };
  EXPECT_EQ(walked(channels(channel("B") + channel("G") + '\0')).channels, 2);
  const std::string both = attribute("channels", "chlist", channel("B") + '\0');
  for (const auto& [bytes, words] :
       {std::pair{channels(channel("B")), "no end of a name in 0 bytes"},
        {channels("B\0"s + "123"), "found 8 bytes"},
        {channels(channel("B") + channel("B") + '\0'),
         "found channel 'B' after 'B'; allowed: unique"},
        {channels(channel("B") + channel("A") + '\0'),
         "found channel 'A' after 'B'; allowed: unique"},
        {channels("B\0"s + test::bytes_of<std::uint32_t>({2, 0, 2, 1}) + '\0'),
         "every 2 x 1 pixels"},
        {one("a\0string\0"s + number(10) + "text", 4), "found 10 bytes; allowed: the 9 bytes left"},
        {one(both + both), "found a second list of channels"},
        {one(attribute("dataWindow", "box2i", "1234")), "found 4 bytes; allowed: the 0 bytes left"},
        {one(attribute(std::string(256, 'n'), "int", "1234")), "no end of a name in 256 bytes"}})
    EXPECT_THAT(rejection(bytes), HasSubstr(words));
}

TEST(ExrHeader, PartsAndAttributesAreBounded) {
  std::string attributes, parts;
  for (int i = 0; i < 1024; ++i) {
    attributes += attribute(fmt::format("a{}", i), "int", "1234");
    parts += part_type("scanlineimage") + '\0';
  }
  expect_accepted(one(attributes));
  EXPECT_THAT(rejection(one(attributes + attribute("b", "int", "1234"))),
              HasSubstr("part 0: found over 1024 attributes"));
  expect_accepted(file(several, parts + '\0'));
  EXPECT_THAT(rejection(file(several, parts + part_type("scanlineimage") + '\0' + '\0')),
              HasSubstr("over 1024 parts"));
}

TEST(ExrHeader, AFileMayEndAnywhere) {
  const std::string whole =
      one(window(4, 4) + attribute("channels", "chlist", channel("Y") + '\0'), 0);
  for (std::size_t length = 0; length < whole.size(); ++length) {
    EXPECT_THAT(rejection(whole.substr(0, length)), AllOf(HasSubstr("a.exr"), HasSubstr("found")))
        << length;
  }
}

// Headers of PNG and JPEG files, and the chunks of a PNG that are passed on to the decoder.

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

}  // namespace clpv::exr_header_test
