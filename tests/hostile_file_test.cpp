// SPDX-License-Identifier: MIT
// Hostile images, and the small files that commands read: centres, weights, points, reports of earlier runs.
#include "image/image_io.hpp"
#include "tests/support/gltf_builder.hpp"
#include "tests/support/hostile.hpp"
#include "tests/support/tiny_images.hpp"

namespace clpv::test::hostile_file_test {
namespace {

const std::string kCornell = CLPV_SOURCE_DIR "/scenes/cornell.json";

Image sample(int width, int height, std::vector<std::string> channels) {
  Image image = make_image(width, height, std::move(channels));
  for (std::size_t i = 0; i < image.pixels.size(); ++i) image.pixels[i] = 0.25f * static_cast<float>(i % 7);
  return image;
}

std::string exr(const Image& image) {
  const TemporaryFolder folder;
  write_exr(folder / "a.exr", image);
  return read_file(folder / "a.exr");
}

std::string sound_exr() {
  return exr(sample(8, 6, {"R", "G", "B", "A"}));
}

/// The sound image with bytes put over what follows that text, so many bytes after it.
std::string exr_with(const std::string& after, std::size_t skip, const std::string& bytes) {
  std::string image = sound_exr();
  const std::size_t at = image.find(after);
  EXPECT_NE(at, std::string::npos) << after;
  image.replace(at + after.size() + skip, bytes.size(), bytes);
  return image;
}

std::string window(std::int32_t x, std::int32_t y) {
  return bytes_of<std::int32_t>({0, 0, x, y});
}

/// `bytes`, held against a sound image.
HostileInput image(const std::string& name, const std::string& bytes, std::vector<std::string> words,
                   const std::string& file = "a.exr") {
  words.push_back(file);
  return {name,
          "compare @/" + file + " @/b.exr -o @/out.png",
          3,
          std::move(words),
          {{file, bytes}, {"b.exr", sound_exr()}}};
}

TEST(HostileFiles, Images) {
  const std::string png = decode_base64(kPngRgba2x2), sound = sound_exr();
  const std::string type = std::string("dataWindow\0box2i\0", 17);
  std::string no_number = sound;
  Image nan = sample(8, 6, {"R", "G", "B", "A"});
  nan.pixels[5] = std::numeric_limits<float>::quiet_NaN();
  std::string huge_png = png, broken_png = png, long_png = png;
  long_png.insert(33, "\x7f\xff\xff\xfftEXtComment");
  huge_png.replace(16, 4, std::string("\0\1\0\0", 4));
  for (std::size_t i = 43; i < 52; ++i) broken_png[i] = '\x55';
  expect_all_refused(
      {
          image("nothing", "", {"no image"}),
          image("a script", "#!/bin/sh\n", {"no image"}),
          image("a PNG by another name", png, {"named as openexr", "png"}),
          image("an EXR by another name", sound, {"named as png", "openexr"}, "a.png"),
          image("a name of another kind", png, {"'.tif'", ".exr, .png and .hdr"}, "a.tif"),
          image("the first bytes alone", sound.substr(0, 4), {"header", "the 0 left"}),
          image("half a header", sound.substr(0, 60), {"part 0", "does not end"}),
          image("half an image", sound.substr(0, sound.size() - 40), {"damaged or truncated"}),
          image("a window without end", exr_with(type, 4, window(2147483647, 2147483647)), {}),
          image("a window wide as the world", exr_with(type, 4, window(99999, 5)), {"100000 x 6", "16384"}),
          image("a window inside out", exr_with(type, 4, window(-5, -5)), {"-4 x -4", "1 to 16384"}),
          image("a text of 2 GiB", exr_with(std::string("capDate\0string\0", 15), 0, "\xff\xff\xff\x7f"),
                {"part 0, attribute 'capDate' (string)", "2147483647 bytes", "left"}),
          image("a text of 2 GiB, of a type of no name",
                exr_with(std::string("capDate\0", 8), 0, std::string("strinx\0\xff\xff\xff\x7f", 11)),
                {"'capDate' (strinx)", "2147483647 bytes"}),
          image("a type that clears the screen",
                exr_with(std::string("capDate\0", 8), 0, std::string("\x1b[2J!!\0\xff\xff\xff\x7f", 11)),
                {"'capDate' (?[2J!!)"}),
          image("a number of 2 GiB",
                exr_with(std::string("pixelAspectRatio\0float\0", 23), 0, "\xff\xff\xff\x7f"),
                {"'pixelAspectRatio' (float)"}),
          image("a compression of no name",
                exr_with(std::string("compression\0compression\0", 24), 4, "\x7f"), {"cannot be read"}),
          image("a part of no type that there is",
                read_file(CLPV_SOURCE_DIR "/tests/fuzz/corpus/image/hostile_part_of_no_type"),
                {"part 0: found type 'scanlin", "scanlineimage, tiledimage"}),
          image("a version of the future",
                [&] {
                  std::string bytes = sound;
                  bytes[4] = '\x09';
                  return bytes;
                }(),
                {"cannot be read"}),
          image("another's size", exr(sample(9, 6, {"R", "G", "B", "A"})), {"9 x 6", "8 x 6"}),
          image("other channels", exr(sample(8, 6, {"Z"})), {}),
          image("a value of no number", exr(nan), {"nan"}),
          image("a PNG whose header was changed", huge_png, {"65536 x 2", "1 to 16384"}, "a.png"),
          image("a PNG with a text of 2 GiB", long_png, {"damaged or truncated"}, "a.png"),
          image("a PNG that does not decode", broken_png, {"damaged"}, "a.png"),
          image("half a PNG", png.substr(0, 40), {}, "a.png"),
          image("an HDR of its first line", "#?RADIANCE\n", {}, "a.hdr"),
          image("an HDR without end", "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 99999999 +X 99999999\n", {},
                "a.hdr"),
          image("an HDR of no pixels", "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 0 +X 0\n", {}, "a.hdr"),
          {"an image that is not there", "compare @/a.exr @/a.exr", 3, {"a.exr", "no such file"}},
          {"a folder for an image", "compare @/a.exr @/a.exr", 3, {"not a regular file"}, {{"a.exr/b", ""}}},
          {"a layer that is not there",
           "compare @/a.exr @/a.exr --layer moon",
           3,
           {"'moon'"},
           {{"a.exr", sound}}},
      },
      30);
}

HostileInput centres(const std::string& name, const std::string& text, std::vector<std::string> words,
                     int code = 3) {
  words.push_back(code == 3 ? "c.json" : "lambda");
  return {name, "basis --centres @/c.json", code, std::move(words), {{"c.json", text}}};
}

TEST(HostileFiles, Centres) {
  std::string many = "[1, 0, 0]";
  for (int i = 1; i < 65; ++i) many += fmt::format(", [{}, 1, 0]", i);
  expect_all_refused(
      {
          centres("nothing", "", {"not JSON"}),
          centres("brackets without end", std::string(100000, '['), {"not JSON"}),
          centres("a list", "[[1, 0, 0]]", {"an object"}),
          centres("no centres", "{}", {"/centres is missing"}),
          centres("centres of none", R"({"centres": []})", {"/centres", "1 to 64"}),
          centres("65 centres", "{\"centres\": [" + many + "]}", {"/centres", "1 to 64"}),
          centres("a centre of two", R"({"centres": [[1, 0]]})", {"/centres/0"}),
          centres("a centre of no length", R"({"centres": [[0, 0, 0]]})", {"/centres/0"}),
          centres("a centre in words", R"({"centres": [["x", 0, 0]]})", {"/centres/0/0", "\"x\""}),
          centres("one centre twice", R"({"centres": [[1, 0, 0], [2, 0, 0]]})", {"/centres/1", "/centres/0"}),
          centres("a bandwidth of 2", R"({"centres": [[1, 0, 0]], "lambda": 2})", {"/lambda"}),
          centres("bandwidths too few", R"({"centres": [[1, 0, 0], [0, 1, 0]], "lambda": [0.5]})",
                  {"/lambda"}),
          centres("a key of no meaning", R"({"centres": [[1, 0, 0]], "colour": 1})", {"\"colour\""}),
          centres("a name of nothing", R"({"centres": [[1, 0, 0]], "name": ""})", {"/name"}),
          centres("centres that cannot be told apart",
                  R"({"centres": [[1, 0, 0], [1, 0.002, 0], [1, 0, 0.002]]})", {}, 2),
          {"a megabyte of centres",
           "basis --centres @/c.json",
           3,
           {"c.json", "bytes"},
           {{"c.json", std::string((1 << 20) + 1, ' ')}}},
          {"a folder of centres", "basis --centres @/c", 3, {"/c: cannot be read"}, {{"c/d", ""}}},
          {"centres that are not there",
           "render " + kCornell + " -o @/out.exr --centres @/none",
           3,
           {"none"}},
      },
      18);
}

HostileInput points(const std::string& name, const std::string& text, std::vector<std::string> words) {
  words.push_back("p.csv");
  return {
      name, "query " + kCornell + " --points @/p.csv -o @/out.csv", 3, std::move(words), {{"p.csv", text}}};
}

TEST(HostileFiles, PointsWeightsAndReports) {
  const std::string bench = "bench bases --filter 'propagate/sh2/soa/float$' --compare @/old.json";
  const auto old = [&](const std::string& name, const std::string& text, std::vector<std::string> words) {
    words.push_back("old.json");
    return HostileInput{name, bench, 3, std::move(words), {{"old.json", text}}};
  };
  const auto weights = [](const std::string& name, const std::string& text, std::vector<std::string> words) {
    words.push_back("w.json");
    return HostileInput{name, "basis --search 4 --weights @/w.json", 3, std::move(words), {{"w.json", text}}};
  };
  expect_all_refused(
      {
          points("five numbers", "0,1,2,0,1\n", {"line 1", "six finite numbers"}),
          points("seven numbers", "0,1,2,0,1,0,0\n", {"line 1"}),
          points("a number of none", "0,1,2,0,1,0\nnan,1,2,0,1,0\n", {"line 2"}),
          points("a number without end", "1e999,1,2,0,1,0\n", {"line 1"}),
          points("a point too far", "1e8,0,0,0,1,0\n", {"line 1", "within"}),
          points("a normal of no length", "0,0,0,0,0,0\n", {"line 1", "a direction"}),
          points("names twice", "x,y,z,nx,ny,nz\nx,y,z,nx,ny,nz\n", {"line 2"}),
          points("zeros", std::string(4096, '\0'), {"line 1"}),
          {"points that are not there", "query " + kCornell + " --points @/none.csv", 3, {"none.csv"}},
          {"a folder of points", "query " + kCornell + " --points @/p", 3, {"a folder"}, {{"p/q", ""}}},
          weights("weights of nothing", "", {"not JSON"}),
          weights("a list for weights", "[]", {}),
          weights("a weight below none", R"({"weights": [[0, 0, 1, -1]]})", {"/weights/0"}),
          weights("a weight of three", R"({"weights": [[0, 0, 1]]})", {"/weights/0"}),
          {"weights that are not there", "basis --search 4 --weights @/none", 3, {"none", "cannot be read"}},
          {"a folder of weights",
           "basis --search 4 --weights @/w",
           3,
           {"/w", "cannot be read"},
           {{"w/x", ""}}},
          old("a report of nothing", "", {"not JSON"}),
          old("a report that is a list", "[]", {}),
          old("a report of another schema", R"({"context": {"schema": 2}, "benchmarks": []})",
              {"/context/schema"}),
          old("a report of rows in words", R"({"context": {"schema": 1}, "benchmarks": "none"})",
              {"/benchmarks"}),
          old("a report of rows without names", R"({"context": {"schema": 1}, "benchmarks": [{}]})",
              {"/benchmarks/0"}),
          {"a report that is not there", bench, 3, {"old.json", "cannot be read"}},
          {"a folder of a report", bench, 3, {"old.json", "cannot be read"}, {{"old.json/a", ""}}},
      },
      23);
}

}  // namespace
}  // namespace clpv::test::hostile_file_test
