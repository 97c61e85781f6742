// SPDX-License-Identifier: MIT
// What is drawn by tools/clpv_draw: `clpv report`, `clpv basis --figures` and `clpv bench --plot`, and what they say where
// Python or a module is missing. Charts and page themselves: tests/draw.
#include <gmock/gmock.h>

#include <filesystem>

#include "image/image_io.hpp"
#include "tests/support/run_here.hpp"

namespace clpv::drawing_test {
namespace {

using test::run_here;
using ::testing::HasSubstr;

class Drawing : public ::testing::Test {
 protected:
  std::string file(const std::string& name) const { return (folder_.path() / name).string(); }

  test::TemporaryFolder folder_;
};

TEST_F(Drawing, WhatIsMissingIsToldBeforeTheWork) {
  folder_.write("matplotlib.py", "raise ImportError('broken matplotlib')\n");
  const auto clpv = [&](const std::string& environment, const std::string& arguments) {
    return test::run(environment + " " CLPV_PROGRAM " " + arguments);
  };
  const test::Outcome no_python = clpv("PATH=/nowhere", "basis sh2 --figures " + file("out"));
  EXPECT_EQ(no_python.exit_code, 1);
  EXPECT_THAT(no_python.err, HasSubstr("--figures: python3 -m clpv_draw ended with 127"));
  const std::string broken = "PYTHONPATH=" + file("");
  for (const auto& [arguments, named] :
       {std::pair("report " + file("out"), "clpv report"),
        {"bench ceilings --filter launch --plot " + file("out"), "--plot"}}) {
    const test::Outcome no_module = clpv(broken, arguments);
    EXPECT_EQ(no_module.exit_code, 1) << named;
    EXPECT_THAT(no_module.err, HasSubstr(named + std::string(": python3 -m clpv_draw ended with 1: broken")));
    EXPECT_THAT(no_module.err, HasSubstr("python3-matplotlib"));
  }
}

TEST_F(Drawing, AFolderThatCannotBeIsTold) {
  folder_.write("file", "");
  for (const std::string command : {"report ", "basis sh2 --figures ", "bench ceilings --plot "}) {
    const test::Outcome outcome = run_here(command + file("file/there"));
    EXPECT_EQ(outcome.exit_code, 1) << command;
    EXPECT_THAT(outcome.err, HasSubstr(file("file/there")));
  }
}

int count(const Image& image, bool (*is)(float red, float blue)) {
  int found = 0;
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) found += is(image.at(x, y, 0), image.at(x, y, 2));
  return found;
}

TEST_F(Drawing, BasisFiguresAreWrittenAndListed) {
  const std::string to = file("new/folder");
  const test::Outcome outcome = run_here("basis srbf8v2 --lobe rotate --figures " + to);
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  for (const char* name : {"figure2.png", "figure3.png", "figure6.png"}) {
    EXPECT_THAT(outcome.out, HasSubstr(name));
    const Image image = read_image(to + "/" + name);
    EXPECT_GT(count(image, [](float red, float blue) { return blue > red + 0.1f; }), 5000) << name;
  }
  // Six lobes of the cube: like sh2's, they reach below 0.
  const Image lobes = read_image(to + "/figure6.png");
  EXPECT_GT(count(lobes, [](float red, float blue) { return red > blue + 0.1f; }), 100);
}

TEST_F(Drawing, AReportIsOnePageWithItsViews) {
  const test::Outcome outcome = run_here(
      "report " + file("page") +
      " " CLPV_SOURCE_DIR "/scenes/cornell.json --width 48 --height 27 --spp 4 --cache " + file("cache"));
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr("index.html"));
  const std::string html = test::read_file(file("page/index.html"));
  EXPECT_THAT(html, HasSubstr("</html>"));
  EXPECT_THAT(html, HasSubstr("--preset best"));
  EXPECT_THAT(html, HasSubstr("clpv: NRMSE"));
}

TEST_F(Drawing, AReportRejectsWithItsOwnExitCode) {
  folder_.write("other.json", R"({"schema": 1})");
  folder_.write("shape.json", R"({"variants": [{"rejected": 0}]})");
  for (const char* name : {"other.json", "shape.json"}) {
    const test::Outcome outcome = run_here("report " + file("page") + " --quality " + file(name));
    EXPECT_EQ(outcome.exit_code, 3) << outcome.err;
    EXPECT_THAT(outcome.err, HasSubstr(file(name)));
    EXPECT_THAT(outcome.err, HasSubstr("variants"));
  }
  EXPECT_EQ(run_here("report " + file("page") + " --bench " + file("absent.json")).exit_code, 3);
  EXPECT_FALSE(std::filesystem::exists(file("page/index.html")));
}

}  // namespace
}  // namespace clpv::drawing_test
