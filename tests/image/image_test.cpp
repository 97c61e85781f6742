// SPDX-License-Identifier: MIT
// Images in and out: files read back as written, byte-identical each time; bad files are rejected
// with the reason. Tone curves and the sRGB encoding against published values.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>

#include "clpv/compare.hpp"
#include "clpv/mesh.hpp"
#include "image/image_io.hpp"
#include "image/tone_map.hpp"
#include "support/output_file.hpp"
#include "tests/support/error_of.hpp"
#include "tests/support/run_program.hpp"

namespace clpv::image_test {
namespace fs = std::filesystem;
using ::testing::HasSubstr;

struct ImageFiles : ::testing::Test {
  /// The error of read_image for a file of these bytes.
  std::string rejection(const std::string& name, const std::string& bytes) {
    write_file(folder_ / name, bytes);
    return rejection(name);
  }
  std::string rejection(const std::string& name) {
    const std::string message =
        test::error_of(ExitCode::bad_input, [&] { read_image(folder_ / name); });
    EXPECT_NE(message.find(name), std::string::npos) << message;
    return message;
  }

  test::TemporaryFolder temporary_;
  const fs::path folder_ = temporary_.path();
};

using test::read_file;

/// Values of many magnitudes, none equal.
Image sample(int width, int height, std::vector<std::string> channels) {
  Image image = make_image(width, height, std::move(channels));
  for (std::size_t i = 0; i < image.pixels.size(); ++i)
    image.pixels[i] = 0.37f * static_cast<float>(i * i % 977);
  return image;
}

TEST_F(ImageFiles, ExrKeepsFloatsLayersAndOptions) {
  Image image;
  append_layer(image, sample(37, 19, {"R", "G", "B", "A"}), "");
  append_layer(image, sample(37, 19, {"R", "G", "B", "A"}), "indirect");
  append_layer(image, sample(37, 19, {"Z"}), "depth");
  image.metadata = {{"basis", "srbf8v2"}, {"lambda", "0.25"}, {"scene", "scenes/a b.json"}};
  write_exr(folder_ / "a.exr", image);

  const Image back = read_image(folder_ / "a.exr");
  EXPECT_EQ(back.encoding, Encoding::linear);
  EXPECT_EQ(back.metadata, image.metadata);
  EXPECT_EQ(layers(back).size(), 3u);
  for (const std::string layer : {"", "indirect", "depth"}) {
    const Image expected = extract_layer(image, layer, "memory"),
                found = extract_layer(back, layer, "a.exr");
    EXPECT_EQ(found.channels, expected.channels) << layer;
    EXPECT_EQ(found.pixels, expected.pixels) << layer;
  }
  const std::string message =
      test::error_of(ExitCode::bad_input, [&] { extract_layer(back, "direct", "a.exr"); });
  EXPECT_NE(message.find("'indirect'"), std::string::npos) << message;
}

TEST_F(ImageFiles, SameImageSameBytes) {
  Image image = sample(16, 16, {"R", "G", "B", "A"});
  image.metadata = {{"basis", "sh2"}};
  write_exr(folder_ / "a.exr", image);
  const std::string first = read_file(folder_ / "a.exr");
  // Two writes within one second would not show a time stamp: the stamp must be the fixed one.
  EXPECT_NE(first.find("1970:01:01 00:00:00"), std::string::npos);
  write_exr(folder_ / "b.exr", image);
  EXPECT_EQ(first, read_file(folder_ / "b.exr"));
  image.encoding = Encoding::srgb;
  write_png(folder_ / "a.png", image);
  write_png(folder_ / "b.png", image);
  EXPECT_EQ(read_file(folder_ / "a.png"), read_file(folder_ / "b.png"));
  EXPECT_EQ(read_file(folder_ / "a.png").find("tIME"), std::string::npos);
}

TEST_F(ImageFiles, PngRoundsToBytesAndKeepsAlphaApart) {
  Image image = make_image(3, 1, {"R", "G", "B", "A"});
  image.encoding = Encoding::srgb;
  image.pixels = {1, 0.5f, 100 / 255.0f, 1, 2, -1, 0.2f, 0.5f, 1, 1, 1, 0};
  write_png(folder_ / "a.png", image);
  const Image back = read_image(folder_ / "a.png");
  EXPECT_EQ(back.encoding, Encoding::srgb);
  const int expected[] = {255, 128, 100, 255, 255, 0, 51, 128, 255, 255, 255, 0};
  ASSERT_EQ(back.pixels.size(), std::size(expected));
  for (std::size_t i = 0; i < back.pixels.size(); ++i)
    EXPECT_NEAR(back.pixels[i] * 255, expected[i], 1e-3) << i;
}

/// `bytes` put over what follows that text, so many bytes after it.
std::string with(std::string image, const std::string& after, std::size_t skip,
                 const std::string& bytes) {
  const std::size_t at = image.find(after);
  EXPECT_NE(at, std::string::npos) << after;
  return image.replace(at + after.size() + skip, bytes.size(), bytes);
}

TEST_F(ImageFiles, RejectsWhatIsNoImageOrTooLarge) {
  Image image = sample(8, 6, {"R", "G", "B"});
  write_exr(folder_ / "good.exr", image);
  image.encoding = Encoding::srgb;
  for (float& value : image.pixels) value /= 400;
  write_png(folder_ / "good.png", image);
  fs::create_directories(folder_ / "folder.exr");
  EXPECT_NE(rejection("missing.exr").find("no file"), std::string::npos);
  EXPECT_NE(rejection("folder.exr").find("a folder"), std::string::npos);

  const std::string exr = read_file(folder_ / "good.exr"), png = read_file(folder_ / "good.png");
  const std::string window("dataWindow\0box2i\0", 17),
      compression("compression\0compression\0", 24);
  std::string huge = png, broken = png, text = png, tiles = exr;
  // The chunk IHDR of 60000 x 60000 pixels, with its checksum.
  huge.replace(16, 17, std::string("\0\0\xea\x60\0\0\xea\x60\x08\x02\0\0\0\x0f\xb0\xe2\x15", 17));
  broken.replace(43, 9, 9, '\x55');
  text.insert(33, "\x7f\xff\xff\xfftEXtComment");
  // A scan-line file made to claim tiles: the attribute "tiles" (two sides and a level mode), and
  // the flag in the version.
  tiles.insert(8, std::string("tiles\0tiledesc\0\x09\0\0\0\x10\0\0\0\0\0\xbb\0\0", 28));
  tiles[5] = static_cast<char>(tiles[5] | 2);
  const std::string hdr = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n";
  const struct {
    const char* name;
    std::string bytes;
    const char* word;
  } rows[] = {
      {"empty.png", "", "unknown format"},
      {"text.exr", "once upon a time", "unknown format"},
      {"a.txt", "x", ".exr, .png, .hdr"},
      {"exr.png", exr, "content is openexr"},
      {"png.exr", png, "content is png"},
      {"wide.exr", with(exr, window, 12, std::string("\x9f\x86\1\0\5\0\0\0", 8)),
       "100000 x 6 pixels; allowed: 1 to 16384"},
      {"inverse.exr", with(exr, window, 12, "\xfb\xff\xff\xff\xfb\xff\xff\xff"), "-4 x -4"},
      {"compression.exr", with(exr, compression, 4, "\x7f"), "cannot be read"},
      {"future.exr", with(exr, "\x76\x2f\x31\x01", 0, "\x09"), "cannot be read"},
      {"tiles.exr", tiles, "tiles of 16 x 12255232"},
      {"huge.png", huge, "60000 x 60000 pixels; allowed: 1 to 16384"},
      {"broken.png", broken, "damaged"},
      {"text.png", text, "damaged or truncated"},
      {"first.hdr", "#?RADIANCE\n", "hdr"},
      {"head.hdr", hdr, "hdr"},
      {"cut.hdr", hdr + "\n-Y 20 +X 20\n" + std::string(100, 'x'), "hdr"},
      {"huge.hdr", hdr + "\n-Y 2000000000 +X 2000000000\n" + std::string(64, 'x'), "hdr"},
      {"none.hdr", hdr + "\n-Y 0 +X 0\n", "hdr"},
  };
  for (const auto& [name, bytes, word] : rows) {
    const std::string message = rejection(name, bytes);
    EXPECT_NE(message.find(word), std::string::npos) << message;
  }
  for (const auto& [name, whole] : {std::pair("cut.exr", exr), {"cut.png", png}}) {
    for (const double share : {0.02, 0.1, 0.5, 0.9, 0.98})
      rejection(name, whole.substr(
                          0, static_cast<std::size_t>(share * static_cast<double>(whole.size()))));
  }
  const std::size_t table =
      exr.find("screenWindowWidth") + std::string("screenWindowWidth.float.size1234.").size();
  for (const std::uint64_t place : {0xffffffffffffffffull, 0x8000000000000000ull,
                                    0xffffffff00000000ull, 1ull << 40, exr.size() - 1ull}) {
    std::string moved = exr;
    std::memcpy(moved.data() + table, &place, sizeof place);
    EXPECT_NE(rejection("moved.exr", moved).find("damaged or truncated"), std::string::npos)
        << place;
  }
  for (const ImageLimits& limits :
       {ImageLimits{.pixel_bytes = 100}, ImageLimits{.channels = 2}, ImageLimits{.file_bytes = 20}})
    EXPECT_THROW(read_image(folder_ / "good.png", limits), Error);
}

TEST(Srgb, PublishedValues) {
  // IEC 61966-2-1: the joint of its two pieces, and the published values of 18 % grey and 0.5.
  EXPECT_FLOAT_EQ(srgb_encode(0), 0);
  EXPECT_NEAR(srgb_encode(1), 1, 1e-6);
  EXPECT_NEAR(srgb_encode(0.0031308f), 0.040449936f, 1e-6);
  EXPECT_NEAR(srgb_encode(0.18f) * 255, 117.6f, 0.1f);
  EXPECT_NEAR(srgb_encode(0.21404114f), 0.5f, 1e-5);
  EXPECT_NEAR(srgb_encode(0.5f) * 255, 187.5f, 0.1f);
}

TEST(ToneCurve, ReinhardOnGreyAndOnColour) {
  EXPECT_NEAR(tone_curve(ToneMap::reinhard, glm::vec3(1)).g, 0.5f, 1e-6);
  EXPECT_NEAR(tone_curve(ToneMap::reinhard, glm::vec3(3)).g, 0.75f, 1e-6);
  const glm::vec3 colour(0.2f, 0.4f, 0.1f), shown = tone_curve(ToneMap::reinhard, colour);
  const float y = luminance(colour);
  EXPECT_NEAR(luminance(shown), y / (1 + y), 1e-6);
  EXPECT_NEAR(shown.r / shown.g, colour.r / colour.g, 1e-5);
}

TEST(ToneCurve, AcesFit) {
  EXPECT_EQ(tone_curve(ToneMap::aces, glm::vec3(0)), glm::vec3(0));
  // (2.51 + 0.03) / (2.43 + 0.59 + 0.14), and white where x(2.51x+0.03) = x(2.43x+0.59)+0.14: 0.08
  // x^2 - 0.56 x - 0.14 = 0.
  EXPECT_NEAR(tone_curve(ToneMap::aces, glm::vec3(1)).r, 2.54f / 3.16f, 1e-6);
  EXPECT_NEAR(tone_curve(ToneMap::aces, glm::vec3(0.18f)).r, 0.2669f, 1e-4);
  const float white = (0.56f + std::sqrt(0.56f * 0.56f + 4 * 0.08f * 0.14f)) / 0.16f;
  EXPECT_LT(tone_curve(ToneMap::aces, glm::vec3(white * 0.99f)).r, 1.0f);
  EXPECT_EQ(tone_curve(ToneMap::aces, glm::vec3(white * 1.01f)).r, 1.0f);
}

TEST(ToneCurve, PhotographicKeepsRatiosOfDarkColours) {
  const glm::vec3 dark = tone_curve(ToneMap::photographic, glm::vec3(1e-3f, 2e-3f, 0));
  EXPECT_NEAR(dark.g / dark.r, 2, 0.01);
  EXPECT_NEAR(tone_curve(ToneMap::photographic, glm::vec3(6)).r, 1, 1e-6);
}

TEST(Exposure, IsAutomaticByTheLogMeanOfLitPixels) {
  Image image = make_image(2, 2, {"R", "G", "B", "A"});
  const float values[] = {0.07f, 0.28f, 0, 5};  // the mean is 0.14: the third is black, the last
  for (int p = 0; p < 4; ++p) {                 // no surface
    for (int c = 0; c < 3; ++c) image.at(p % 2, p / 2, c) = values[p];
    image.at(p % 2, p / 2, 3) = p < 3 ? 1.0f : 0.0f;
  }
  EXPECT_NEAR(automatic_exposure(image), 0, 1e-5);
  for (float& value : image.pixels) value *= 8;
  EXPECT_NEAR(automatic_exposure(image), -3, 1e-5);
  image.metadata["view"] = "albedo";
  EXPECT_EQ(automatic_exposure(image), 0);
  EXPECT_EQ(automatic_exposure(make_image(1, 1, {"R", "G", "B"})), 0) << "nothing is lit";
}

TEST(ToneCurve, RisesAndStaysInRange) {
  for (const ToneMap curve : values_of<ToneMap>()) {
    float before = 0;
    for (float x = 1e-4f; x < 1e30f; x *= 1.5f) {
      const float shown = tone_curve(curve, glm::vec3(x)).g;
      EXPECT_GE(shown, before) << name_of(curve) << " at " << x;
      EXPECT_LE(shown, 1.0f);
      before = shown;
    }
    EXPECT_GT(before, 0.99f);
    const float infinity = std::numeric_limits<float>::infinity();
    EXPECT_GT(tone_curve(curve, glm::vec3(infinity)).g, 0.99f);
  }
}

TEST(PublicImage, FieldsMustAgree) {
  const auto rejected = [](const Image& image) {
    const std::string path = ::testing::TempDir() + "clpv_fields.exr";
    return test::error_of(ExitCode::bad_input, [&] { save_image(path, image); });
  };
  Image image = make_image(2, 2, {"R", "G", "B"});
  image.pixels.pop_back();
  EXPECT_THAT(rejected(image), HasSubstr("found 11 numbers for 2 x 2 pixels of 3 channels, "
                                         "allowed: 12"));
  test::error_of(ExitCode::bad_input, [&] { compare(image, image); });
  test::error_of(ExitCode::bad_input, [&] { Material::Texture::of(image); });
  image.width = -1;
  EXPECT_THAT(rejected(image), HasSubstr("found -1 x 2 pixels, allowed: 1 to 16384"));
  for (const std::vector<std::string>& names : {std::vector<std::string>{"R", "R", "B"},
                                                {"R", "G", ""},
                                                {"R", "G", std::string("a\0b", 3)}})
    EXPECT_THAT(rejected(make_image(1, 1, names)), HasSubstr("allowed: unique names"));
  Image encoded = make_image(1, 1, {"R", "G", "B"});
  encoded.encoding = Encoding::srgb;
  EXPECT_THAT(rejected(encoded), HasSubstr("found sRGB-encoded values, allowed: linear"));
}

TEST(DisplayImage, ShowsLinearColoursAlone) {
  const auto error = [](ExitCode code, const Image& image, float exposure) {
    return test::error_of(code, [&] { display_image(image, exposure, ToneMap::aces); });
  };
  EXPECT_THAT(error(ExitCode::bad_input, make_image(1, 1, {"Y"}), 0),
              HasSubstr("found channels Y, allowed: R, G, B"));
  EXPECT_THAT(error(ExitCode::usage, make_image(1, 1, {"R", "G", "B"}), NAN),
              HasSubstr("exposure: found nan"));
}

TEST(DisplayImage, ExposureDoublesAndBackgroundIsBlackOrClear) {
  Image image = make_image(2, 1, {"R", "G", "B", "A"});
  image.pixels = {0.1f, 0.2f, 0.3f, 1, 5, 5, 5, 0};
  const Image opaque = display_image(image, 1, ToneMap::none),
              shown = display_image(image, 1, ToneMap::none, Background::transparent);
  EXPECT_EQ(opaque.channels, (std::vector<std::string>{"R", "G", "B"}));
  for (int c = 0; c < 3; ++c) {
    EXPECT_EQ(opaque.at(0, 0, c), shown.at(0, 0, c));
    EXPECT_EQ(opaque.at(1, 0, c), 0.0f);
  }
  EXPECT_EQ(shown.encoding, Encoding::srgb);
  EXPECT_NEAR(shown.at(0, 0, 0), srgb_encode(0.2f), 1e-6);
  EXPECT_NEAR(shown.at(0, 0, 2), srgb_encode(0.6f), 1e-6);
  EXPECT_EQ(shown.at(0, 0, 3), 1.0f);
  for (int c = 0; c < 4; ++c) EXPECT_EQ(shown.at(1, 0, c), 0.0f);
}

}  // namespace clpv::image_test
