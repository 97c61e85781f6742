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

namespace {

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

TEST(ExrHeader, IsWhatOpenExrReads) {
  int images = 0;
  for (const auto& entry :
       std::filesystem::directory_iterator(CLPV_SOURCE_DIR "/tests/fuzz/corpus/image")) {
    const std::string bytes = test::read_file(entry.path());
    if (!bytes.starts_with("\x76\x2f\x31\x01") ||
        entry.path().filename().string().starts_with("hostile_"))
      continue;
    const test::TemporaryFolder folder;
    const Image image = read_image(folder.write("a.exr", bytes));
    const ExrHeader declared = walked(bytes);
    EXPECT_EQ(declared.display.width(), image.width) << entry.path();
    EXPECT_EQ(declared.display.height(), image.height) << entry.path();
    std::int64_t channels = 0;
    for (const ExrHeader& part : parts_of(bytes)) channels += part.channels;
    EXPECT_EQ(channels, static_cast<int>(image.channels.size())) << entry.path();
    EXPECT_EQ(declared.tiled, entry.path().string().ends_with("_tile")) << entry.path();
    EXPECT_FALSE(declared.deep);
    ++images;
  }
  EXPECT_GE(images, 7);
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

TEST(ExrHeader, ValuesHaveTheSizeOfTheirTypes) {
  // OpenEXR would read past a shorter one, and would take the rest of a longer one for attributes.
  for (const std::string& type : test::words_of(
           "box2f box2i chromaticities compression deepImageState double envmap float int keycode "
           "lineOrder m33d m33f m44d m44f rational tiledesc timecode v2d v2f v2i v3d v3f v3i")) {
    EXPECT_THAT(rejection(one(attribute("a", type, ""))),
                HasSubstr("'a' (" + type + "): found 0 bytes"));
    EXPECT_THAT(rejection(one(attribute("a", type, std::string(200, '\0')))),
                HasSubstr("found 200 bytes"));
  }
  EXPECT_THAT(rejection(one(attribute("a", "floatvector", "12345"))), HasSubstr("4 per number"));
}

TEST(ExrHeader, ValuesHaveTheSizeThatTheySay) {
  const auto preview = [](std::uint32_t width, std::uint32_t height, std::size_t bytes) {
    return one(
        attribute("preview", "preview", number(width) + number(height) + std::string(bytes, 'x')));
  };
  expect_accepted(preview(2, 3, 24));
  for (const std::string& bytes :
       {preview(2, 3, 23), preview(2, 3, 28), preview(40000, 40000, 24),
        preview(0xffffffffu, 0xffffffffu, 4), preview(0x7fffffff, 0x7fffffff, 4)}) {
    EXPECT_THAT(rejection(bytes), HasSubstr("pixels in"));
  }
  EXPECT_THAT(rejection(one(attribute("preview", "preview", "1234567"))),
              HasSubstr("found 7 bytes"));
  const auto texts = [](const std::string& value) {
    return one(attribute("a", "stringvector", value));
  };
  expect_accepted(texts(number(1) + "a" + number(0) + number(2) + "bc"));
  EXPECT_THAT(rejection(texts(number(1) + "a" + number(9) + "bc")), HasSubstr("found 9 bytes"));
  EXPECT_THAT(rejection(texts(number(1) + "ab")), HasSubstr("found 4 bytes"));
}

TEST(ExrHeader, ChannelsAreCountedAndEndWhereTheySay) {
  const auto channels = [](const std::string& list) {
    return one(attribute("channels", "chlist", list));
  };
  EXPECT_EQ(walked(channels(channel("B") + channel("G") + '\0')).channels, 2);
  EXPECT_EQ(walked(channels("\0"s)).channels, 0);
  EXPECT_THAT(rejection(channels(channel("B"))), HasSubstr("no end of a name in 0 bytes"));
  EXPECT_THAT(rejection(channels(channel("B") + '\0' + "more")),
              HasSubstr("4 bytes after the last channel"));
  EXPECT_THAT(rejection(channels("B\0"s + "123")), HasSubstr("found 16 bytes"));
  for (const char* second : {"B", "A"}) {
    EXPECT_THAT(rejection(channels(channel("B") + channel(second) + '\0')),
                HasSubstr("found channel '"s + second + "' after 'B'; allowed: unique names"));
  }
  EXPECT_THAT(rejection(one(attribute(std::string(256, 'n'), "int", "1234"))),
              HasSubstr("no end of a name in 256 bytes"));
}

TEST(ExrHeader, NamesAreThereOnce) {
  EXPECT_THAT(rejection(one(window(4, 4) + window(4, 4), 64)),
              HasSubstr("attribute 'dataWindow' (box2i): found a duplicate attribute"));
  const std::string part = window(4, 4) + part_type("scanlineimage") + '\0';
  expect_accepted(file(several, part + part + '\0', 64));
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

TEST(ExrHeader, TablesOfChunksFitIntoTheFile) {
  const auto compressed = [](char kind) {
    return attribute("compression", "compression", std::string(1, kind));
  };
  // 1000 rows: one by one, by 16 (ZIP), by 256 (DWAB), each with 8 bytes in the table.
  for (const auto& [kind, chunks] : {std::pair{'\0', 1000}, {'\3', 63}, {'\11', 4}, {'\177', 4}}) {
    const std::string attributes = window(5, 1000) + compressed(kind);
    expect_accepted(one(attributes, 8 * chunks));
    EXPECT_THAT(rejection(one(attributes, 8 * chunks - 1)),
                HasSubstr(fmt::format("part 0: found {} chunks", chunks)));
  }
  const auto tiles = [](std::uint32_t width, std::uint32_t height) {
    return window(16384, 16384) +
           attribute("tiles", "tiledesc", number(width) + number(height) + '\0');
  };
  EXPECT_THAT(rejection(file(tiled, tiles(1, 1) + '\0')), HasSubstr("found 268435456 chunks"));
  expect_accepted(file(tiled, tiles(16384, 8192) + '\0', 16));
  expect_accepted(file(tiled, tiles(0, 0) + '\0', 0));  // which OpenEXR does
  EXPECT_THAT(rejection(one(attribute("chunkCount", "int", number(1u << 30)))),
              HasSubstr("1073741824 chunks"));
  // 4 chunks, and as many.
  const std::string part = window(4, 4) + part_type("scanlineimage") + '\0';
  expect_accepted(file(several, part + part + '\0', 64));
  EXPECT_THAT(rejection(file(several, part + part + '\0', 8)), HasSubstr("part 1: found 4 chunks"));
  EXPECT_THAT(rejection(file(several, part + part + '\0', 40)),
              HasSubstr("all parts: found 8 chunks; allowed: 5,"));
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

}  // namespace
}  // namespace clpv::exr_header_test
