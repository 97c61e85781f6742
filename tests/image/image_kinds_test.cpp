// SPDX-License-Identifier: MIT
// Kinds of EXR and PNG files (docs/scenes.md, "Images"): windows, parts, types and primaries.
// Each is converted or rejected by name.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "image/compare.hpp"
#include "image/image_header.hpp"
#include "image/image_io.hpp"
#include "scene/sky.hpp"
#include "support/output_file.hpp"
#include "tests/support/gltf_builder.hpp"
#include "tests/support/run_here.hpp"
#include "tests/support/tiny_images.hpp"

namespace clpv::test {

// EXR files of uncompressed scanlines, byte by byte: windows, parts and types that clpv does not
// write.

struct ExrBox {
  int left, top, right, bottom;  ///< both corners are included
};

struct ExrPart {
  std::vector<std::string> channels;  ///< in alphabetical order
  ExrBox data, display;
  /// By channel and coordinates.
  std::function<float(const std::string& channel, int x, int y)> value;
  std::string name = {};                ///< name of one of several parts
  std::vector<std::string> integers{};  ///< channels of type UINT; the others are FLOAT
  std::vector<float> chromaticities{};  ///< attribute, unless empty
  std::string attributes = {};          ///< more of them
};

inline std::string exr_attribute(const std::string& name, const std::string& type,
                                 const std::string& value) {
  return name + '\0' + type + '\0' +
         bytes_of<std::uint32_t>({static_cast<std::uint32_t>(value.size())}) + value;
}

inline std::string exr_box(const std::string& name, const ExrBox& box) {
  return exr_attribute(name, "box2i",
                       bytes_of<std::int32_t>({box.left, box.top, box.right, box.bottom}));
}

inline bool is_integer(const ExrPart& part, const std::string& channel) {
  return std::ranges::count(part.integers, channel) > 0;
}

inline std::string exr_header(const ExrPart& part, bool several) {
  std::string channels;
  for (const std::string& name : part.channels)
    channels += name + '\0' + bytes_of<std::uint32_t>({is_integer(part, name) ? 0u : 2u, 0, 1, 1});
  const int rows = part.data.bottom - part.data.top + 1;
  std::string header = exr_attribute("channels", "chlist", channels + '\0') +
                       exr_attribute("compression", "compression", std::string(1, '\0')) +
                       exr_box("dataWindow", part.data) + exr_box("displayWindow", part.display) +
                       exr_attribute("lineOrder", "lineOrder", std::string(1, '\0')) +
                       exr_attribute("pixelAspectRatio", "float", bytes_of<float>({1})) +
                       exr_attribute("screenWindowCenter", "v2f", bytes_of<float>({0, 0})) +
                       exr_attribute("screenWindowWidth", "float", bytes_of<float>({1})) +
                       part.attributes;
  if (!part.chromaticities.empty()) {
    std::string numbers;
    for (const float number : part.chromaticities) numbers += bytes_of<float>({number});
    header += exr_attribute("chromaticities", "chromaticities", numbers);
  }
  if (several) {
    header += exr_attribute("name", "string", part.name) +
              exr_attribute("type", "string", "scanlineimage") +
              exr_attribute("chunkCount", "int", bytes_of<std::int32_t>({rows}));
  }
  return header + '\0';
}

/// The pixels of one row, channel by channel.
inline std::string exr_row(const ExrPart& part, int y) {
  std::string row;
  for (const std::string& name : part.channels) {
    for (int x = part.data.left; x <= part.data.right; ++x) {
      const float value = part.value(name, x, y);
      row +=
          bytes_of<std::uint32_t>({is_integer(part, name) ? static_cast<std::uint32_t>(value)
                                                          : std::bit_cast<std::uint32_t>(value)});
    }
  }
  return row;
}

/// A file of one part or several.
inline std::string exr_file(const std::vector<ExrPart>& parts) {
  const bool several = parts.size() > 1;
  std::string file = "\x76\x2f\x31\x01" + bytes_of<std::uint32_t>({several ? 0x1002u : 2u});
  std::size_t rows = 0;
  for (const ExrPart& part : parts) {
    file += exr_header(part, several);
    rows += static_cast<std::size_t>(part.data.bottom - part.data.top + 1);
  }
  if (several) file += '\0';
  std::string table, chunks;
  const std::size_t first = file.size() + 8 * rows;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    for (int y = parts[i].data.top; y <= parts[i].data.bottom; ++y) {
      table += bytes_of<std::uint64_t>({first + chunks.size()});
      const std::string row = exr_row(parts[i], y);
      if (several) chunks += bytes_of<std::uint32_t>({static_cast<std::uint32_t>(i)});
      chunks += bytes_of<std::int32_t>({y, static_cast<std::int32_t>(row.size())}) + row;
    }
  }
  return file + table + chunks;
}

}  // namespace clpv::test

namespace clpv::image_kinds_test {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using namespace std::string_literals;

constexpr test::ExrBox kDisplay{0, 0, 23, 12};

/// A pattern by coordinates; 9 outside the display window.
float pattern(const std::string&, int x, int y) {
  const bool inside = x >= 0 && x <= kDisplay.right && y >= 0 && y <= kDisplay.bottom;
  return inside ? static_cast<float>(0.5 + 0.45 * std::sin(x / 7.0) * std::cos(y / 11.0)) : 9.0f;
}

test::ExrPart grey(const test::ExrBox& data, const test::ExrBox& display = kDisplay) {
  return {.channels = {"B", "G", "R"}, .data = data, .display = display, .value = pattern};
}

Image exr(const std::vector<test::ExrPart>& parts) {
  return decode_image("a.exr", test::exr_file(parts));
}

std::string rejection(const std::string& name, const std::string& bytes) {
  return test::error_of(ExitCode::bad_input, [&] { decode_image(name, bytes); });
}

std::string rejection(const std::vector<test::ExrPart>& parts) {
  return rejection("a.exr", test::exr_file(parts));
}

std::string comparison_error(const Image& a, const Image& b) {
  return test::error_of(ExitCode::bad_input, [&] { compare(a, "a.exr", b, "b.exr"); });
}

TEST(ExrWindows, PixelsLieByTheirCoordinatesInTheDisplayWindow) {
  const Image truth = exr({grey(kDisplay)});
  const Image shifted = exr({grey({3, 0, 26, 12})});
  EXPECT_EQ(shifted.width, 24);
  EXPECT_EQ(shifted.windows.at(""), (PixelWindow{3, 0, 24, 13}));
  for (int x = 0; x < 24; ++x) {
    EXPECT_EQ(shifted.at(x, 5, 0), x < 3 ? 0.0f : truth.at(x, 5, 0)) << x;
  }
  EXPECT_THAT(truth.windows, IsEmpty());
  test::ExrPart memory_order = grey({3, 0, 26, 12});
  memory_order.value = [](const std::string& name, int x, int y) {
    return pattern(name, x - 3, y);
  };
  const Image displaced = exr({memory_order});
  EXPECT_GT(compare(displaced, "a", shifted, "b").nrmse.value(), 0.05) << "displaced by 3 pixels";
}

TEST(ExrWindows, OverscanIsCut) {
  const Image truth = exr({grey(kDisplay)}), overscan = exr({grey({-4, -2, 30, 15})});
  EXPECT_TRUE(compare(overscan, "a", truth, "b").identical);
  test::ExrPart elsewhere = grey({-100, -50, -77, -38}, {-100, -50, -77, -38});
  elsewhere.value = [](const std::string& name, int x, int y) {
    return pattern(name, x + 100, y + 50);
  };
  EXPECT_TRUE(compare(exr({elsewhere}), "a", truth, "b").identical);
  EXPECT_THAT(
      rejection({grey({30, 0, 40, 12})}),
      HasSubstr("a.exr: found the data window (30, 0) to (40, 12) outside the display window "
                "(0, 0) to (23, 12)"));
}

TEST(ExrWindows, ImagesOfTheSamePixelsAreCompared) {
  const Image truth = exr({grey(kDisplay)}), crop = exr({grey({6, 2, 17, 12})});
  EXPECT_THAT(
      comparison_error(crop, truth),
      HasSubstr("a.exr has only pixels (6, 2) to (17, 12) of 24 x 13, b.exr has all pixels"));
  EXPECT_THAT(comparison_error(truth, crop), HasSubstr("a.exr has all pixels"));
  Image other = crop;
  for (float& value : other.pixels) value += value > 0 ? 0.5f : 0.0f;
  const Comparison errors = compare(other, "a", crop, "b");
  EXPECT_NEAR(errors.rmse, 0.5, 1e-6) << "absent pixels count as no pixels";
  EXPECT_EQ(errors.valid_pixels, 12u * 11u);
  EXPECT_GT(errors.mean_luminance[1], 0.4);
}

Sky sky_of(const std::string& bytes) {
  const test::TemporaryFolder folder;
  return read_sky(folder.write("sky.exr", bytes), 1, 0);
}

TEST(ExrWindows, ASkyHasItsRadianceWhereItsDisplayWindowSays) {
  const test::ExrBox map{0, 0, 15, 7};
  test::ExrPart whole = grey(map, map);
  whole.value = [](const std::string&, int x, int y) {
    return y < 4 && x >= 0 && x < 16 ? static_cast<float>(1 + x) : 0.0f;
  };
  const Sky full = sky_of(test::exr_file({whole}));
  EXPECT_THAT(full.notes, IsEmpty());
  test::ExrPart top = whole, overscan = whole, right = whole;
  top.data = {0, 0, 15, 3};
  overscan.data = {-2, -2, 17, 9};
  right.data = {8, 0, 15, 7};
  const Sky of_top = sky_of(test::exr_file({top}));
  EXPECT_EQ(of_top.height, 8);
  EXPECT_EQ(of_top.texels, full.texels);
  EXPECT_THAT(of_top.notes,
              ElementsAre(HasSubstr("sky.exr: has only pixels (0, 0) to (15, 3) of 16 x 8")));
  EXPECT_EQ(sky_of(test::exr_file({overscan})).width, 16);
  const Sky of_right = sky_of(test::exr_file({right}));
  EXPECT_EQ(of_right.radiance(glm::dvec3(1, 0.2, 0.01)).x, full.radiance({1, 0.2, 0.01}).x);
  EXPECT_EQ(of_right.radiance(glm::dvec3(-1, 0.2, 0.01)).x, 0);
}

TEST(ExrKinds, IntegersAreNumbers) {
  const auto value = [](const std::string& name, int x, int) {
    return static_cast<float>(name == "id" ? 1 << (x % 24) : x);
  };
  test::ExrPart numbers = grey({0, 0, 23, 1}, {0, 0, 23, 1});
  numbers.value = value, numbers.channels = {"B", "G", "R", "id"};
  for (const std::vector<std::string>& integers :
       {std::vector<std::string>{"id"}, {"G", "id"}, {"B", "G", "R", "id"}}) {
    numbers.integers = integers;
    const Image image = exr({numbers});
    for (const char* name : {"R", "G", "B"})
      EXPECT_EQ(image.at(3, 1, image.channel(name).value()), 3.0f) << name;
    EXPECT_EQ(image.at(22, 1, image.channel("id").value()), 4194304.0f);
  }
}

test::ExrPart named(const std::string& name, std::vector<std::string> channels, float factor) {
  return {
      .channels = std::move(channels),
      .data = kDisplay,
      .display = kDisplay,
      .value = [factor](const std::string& c, int x, int y) { return factor * pattern(c, x, y); },
      .name = name};
}

TEST(ExrParts, AreLayers) {
  test::ExrPart small = named("depth", {"Z"}, 3);
  small.data = {4, 4, 20, 12};
  const Image image =
      exr({named("beauty", {"B", "G", "R"}, 1), small, named("sun", {"B", "G", "R", "sun.A"}, 2)});
  EXPECT_THAT(image.parts, ElementsAre("beauty", "depth", "sun"));
  EXPECT_THAT(layers(image), ElementsAre("beauty", "depth", "sun"));
  EXPECT_EQ(extract_layer(image, "sun", "a").at(7, 5, 0), 2 * pattern("", 7, 5));
  EXPECT_EQ(extract_layer(image, "depth", "a").at(7, 5, 0), 3 * pattern("", 7, 5));
  EXPECT_EQ(extract_layer(image, "depth", "a").at(1, 5, 0), 0);
  EXPECT_EQ(extract_layer(image, "depth", "a").windows.at(""), (PixelWindow{4, 4, 21, 13}));
  EXPECT_THAT(extract_layer(image, "sun", "a").windows, IsEmpty());
  EXPECT_THAT(test::error_of(ExitCode::bad_input, [&] { extract_layer(image, "", "a.exr"); }),
              HasSubstr("a.exr: no layer ''; allowed: 'beauty', 'depth', 'sun'"));
}

TEST(ExrParts, TheOnlyPartWithColoursNeedsNoName) {
  const Image image = exr({named("depth", {"Z"}, 3), named("beauty", {"B", "G", "R"}, 2)});
  EXPECT_EQ(extract_layer(image, "", "a").at(7, 5, 0), 2 * pattern("", 7, 5));
  const Image layered = exr({named("depth", {"Z"}, 3), named("all", {"x.B", "x.G", "x.R"}, 2)});
  EXPECT_EQ(extract_layer(layered, "x", "a").at(7, 5, 0), 2 * pattern("", 7, 5));
}

TEST(ExrParts, AreSelectedByNameInCompareAndRejectedAsASky) {
  const test::TemporaryFolder folder;
  const auto two = folder.write("two.exr", test::exr_file({named("beauty", {"B", "G", "R"}, 1),
                                                           named("sun", {"B", "G", "R"}, 2)}));
  const auto sun = folder.write("sun.exr", test::exr_file({named("", {"B", "G", "R"}, 2)}));
  const auto compared = [&](const std::string& part) {
    return test::run_here("compare " + two.string() + part + " " + sun.string());
  };
  EXPECT_THAT(compared(":sun").out, HasSubstr("\"identical\": true"));
  EXPECT_THAT(compared(":beauty").out, HasSubstr("\"identical\": false"));
  const test::Outcome unnamed = compared("");
  EXPECT_EQ(unnamed.exit_code, 3);
  EXPECT_THAT(unnamed.err, HasSubstr("no layer ''; allowed: 'beauty', 'sun'"));
  EXPECT_THAT(test::error_of(ExitCode::bad_input, [&] { read_sky(two, 1, 0); }),
              HasSubstr("'beauty', 'sun'"));
}

TEST(ExrParts, OfTheNameOfALayerAreNoted) {
  const Image image =
      exr({named("main", {"sun.B", "sun.G", "sun.R"}, 1), named("sun", {"B", "G", "R"}, 2)});
  const Image sun = extract_layer(image, "sun", "a");
  EXPECT_EQ(sun.at(7, 5, 0), 2 * pattern("", 7, 5));
  EXPECT_THAT(sun.notes, ElementsAre("layer 'sun' is read, not 'main.sun'"));
  EXPECT_THAT(extract_layer(image, "main.sun", "a").notes, IsEmpty());
  EXPECT_THAT(rejection({named("a", {"b.Y"}, 1), named("a.b", {"Y"}, 2)}),
              HasSubstr("part 'a.b', channel 'Y': found a.b.Y twice"));
  EXPECT_THAT(rejection({named("a", {"Y", "a.Y"}, 1), named("b", {"Y"}, 2)}),
              HasSubstr("part 'a', channel 'a.Y': found a.Y twice"));
}

TEST(ExrParts, HaveUniqueNamesAndOneDisplayWindow) {
  EXPECT_THAT(rejection({named("a", {"Y"}, 1), named("a", {"Y"}, 2)}),
              HasSubstr("found two parts of the name 'a'"));
  test::ExrPart wider = named("b", {"Y"}, 1);
  wider.display.right = 30;
  EXPECT_THAT(rejection({named("a", {"Y"}, 1), wider}),
              HasSubstr("part 'b': found the display window (0, 0) to (30, 12); allowed: (0, 0) to "
                        "(23, 12)"));
}

TEST(ExrKinds, CubeMapsAreRejected) {
  test::ExrPart cube = grey(kDisplay);
  cube.attributes = test::exr_attribute("envmap", "envmap", "\1");
  EXPECT_THAT(rejection({cube}), HasSubstr("cube map"));
}

void expect_rows(const Chromaticities& from, const double (&expected)[3][3]) {
  const glm::dmat3 matrix = to_rec709(from).value();
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column)
      EXPECT_NEAR(matrix[column][row], expected[row][column], 2e-4) << row << ' ' << column;
  }
}

TEST(Primaries, PublishedMatrices) {
  // ITU-R BT.2087, and ACEScg of the Academy's CTL with Bradford's adaptation from D60 to D65.
  expect_rows({0.708, 0.292, 0.17, 0.797, 0.131, 0.046, 0.3127, 0.329},
              {{1.6605, -0.5876, -0.0728}, {-0.1246, 1.1329, -0.0083}, {-0.0182, -0.1006, 1.1187}});
  expect_rows({0.713, 0.293, 0.165, 0.83, 0.128, 0.044, 0.32168, 0.33767},
              {{1.70505, -0.62179, -0.08326},
               {-0.13026, 1.14080, -0.01055},
               {-0.02400, -0.12897, 1.15297}});
  expect_rows(kRec709, {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}});
  EXPECT_FALSE(to_rec709({0.3, 0.3, 0.3, 0.3, 0.1, 0.1, 0.3, 0.3}));
  EXPECT_FALSE(to_rec709({0.64, 0.33, 0.3, 0.6, 0.15, 0.06, 0.3127, 0}));
}

TEST(Primaries, ColoursOfAnExrAreThoseOfRec709) {
  test::ExrPart wide = grey(kDisplay);
  wide.channels = {"B", "G", "R", "Z"};
  wide.value = [](const std::string& name, int, int) { return name == "R" ? 1.0f : 0.25f; };
  const Image plain = exr({wide});
  wide.chromaticities = {0.64f, 0.33f, 0.3f, 0.6f, 0.15f, 0.06f, 0.3127f, 0.329f};
  EXPECT_EQ(exr({wide}).pixels, plain.pixels);
  EXPECT_THAT(exr({wide}).notes, IsEmpty());
  wide.chromaticities = {0.708f, 0.292f, 0.17f, 0.797f, 0.131f, 0.046f, 0.3127f, 0.329f};
  const Image image = exr({wide});
  const auto at = [&](const char* name) { return image.at(2, 2, image.channel(name).value()); };
  EXPECT_NEAR(at("R"), 1.6605 - 0.25 * (0.5876 + 0.0728), 1e-3);
  EXPECT_NEAR(at("G"), -0.1246 + 0.25 * (1.1329 - 0.0083), 1e-3);
  EXPECT_EQ(at("Z"), 0.25f);
  EXPECT_THAT(image.notes, ElementsAre(testing::AllOf(HasSubstr("chromaticities 0.708,0.292"),
                                                      HasSubstr("converted to Rec. 709"))));
  wide.chromaticities = {0, 0, 0, 0, 0, 0, 0, 0};
  EXPECT_THAT(rejection({wide}), HasSubstr("allowed: three colours and a white"));
}

TEST(PngKinds, AreConverted) {
  const auto png = [](std::string_view base64) {
    return decode_image("a.png", test::decode_base64(base64));
  };
  EXPECT_NEAR(png(test::kPngGrey).at(0, 0, 0) * 255, 77, 1e-3);
  EXPECT_THAT(png(test::kPngGrey).channels, ElementsAre("Y"));
  EXPECT_NEAR(png(test::kPngGrey16).at(0, 0, 0) * 255, 77, 1e-3);
  const Image palette = png(test::kPngPalette);
  EXPECT_THAT(palette.channels, ElementsAre("R", "G", "B"));
  EXPECT_NEAR(palette.at(0, 0, 2) * 255, 30, 1e-3);
}

/// A PNG with a chunk before its pixels. Its checksum is wrong, which nobody reads.
std::string with_chunk(const std::string& type, const std::string& data) {
  std::string png = test::decode_base64(test::kPngGrey);
  const auto length = static_cast<char>(data.size());
  return png.insert(33, "\0\0\0"s + length + type + data + "\0\0\0\0"s);
}

TEST(PngKinds, ColourDataOtherThanSrgbIsNamed) {
  const auto notes = [](const std::string& png) { return decode_image("a.png", png).notes; };
  EXPECT_THAT(notes(with_chunk("gAMA", "\0\1\x86\xa0"s)),
              ElementsAre("gAMA 1: not read; values are taken as sRGB"));
  EXPECT_THAT(notes(with_chunk("gAMA", "\0\0\xb1\x8f"s)), IsEmpty());
  EXPECT_THAT(notes(with_chunk("iCCP", "Display P3\0\0x"s)),
              ElementsAre(HasSubstr("'Display P3'")));
  EXPECT_THAT(notes(with_chunk("cHRM", std::string(32, '\1'))), ElementsAre(HasSubstr("cHRM")));
  EXPECT_THAT(notes(with_chunk("sRGB", "\0"s)), IsEmpty());
  std::string both = with_chunk("gAMA", "\0\1\x86\xa0"s);
  both.insert(33, "\0\0\0\1sRGB\0\0\0\0\0"s);
  EXPECT_THAT(notes(both), IsEmpty());
}

}  // namespace clpv::image_kinds_test
