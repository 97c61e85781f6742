// SPDX-License-Identifier: MIT
// Commands that draw with python/clpv/draw: `clpv report`, `clpv basis --figures` and `clpv bench
// --plot`, and their errors where Python or a module is missing. tests/draw has the charts and the
// page.
#include <gmock/gmock.h>

#include <filesystem>

#include "image/image_io.hpp"
#include "tests/support/run_here.hpp"
#include "tests/support/scenes.hpp"

namespace clpv::drawing_test {
namespace {

using test::must_run_here;
using test::run_here;
using ::testing::HasSubstr;

class Drawing : public ::testing::Test {
 protected:
  std::string file(const std::string& name) const { return (folder_.path() / name).string(); }

  test::TemporaryFolder folder_;
};

TEST_F(Drawing, BasisFiguresAreWrittenAndListed) {
  const std::string to = file("new/folder");
  const test::Outcome outcome = must_run_here("basis srbf8v2 --lobe rotate --figures " + to);
  for (const char* name : {"figure2.png", "figure3.png", "figure6.png"}) {
    EXPECT_THAT(outcome.out, HasSubstr(name));
    EXPECT_GT(read_image(to + "/" + name).width, 100) << name;
  }
}

/// A box under a sky, which the published scheme does not have.
class SkyReport : public Drawing {
 protected:
  SkyReport() {
    std::filesystem::copy(CLPV_SOURCE_DIR "/scenes/cornell.glb", folder_.path());
    folder_.write("sky.json", R"({"model": "cornell.glb", "metres_per_unit": 1,
                                  "sky": {"radiance": [1, 1, 1]},
                                  "cameras": [{"name": "front", "eye": [0.28, 0.27, -0.8],
                                               "target": [0.28, 0.27, 0]}]})");
  }
};

TEST_F(SkyReport, IsOnePageWithItsViewsAndLeavesOutWhatHasNoSky) {
  const std::string scene = " " + file("sky.json") + " --width 48",
                    report = "report " + file("page") + scene + " --spp 4 --cache " + file("cache");
  std::filesystem::create_directory(file("none"));
  const test::Outcome missing = run_here(report + " --height 27 --images " + file("none"));
  EXPECT_EQ(missing.exit_code, 3);
  EXPECT_THAT(missing.err, HasSubstr("none/sky-front.exr"));
  std::filesystem::create_directory(file("theirs"));
  ASSERT_EQ(
      run_here("render" + scene + " --height 27 -o " + file("theirs/sky-front.exr")).exit_code, 0);
  const test::Outcome larger = run_here(report + " --height 28 --images " + file("theirs"));
  EXPECT_EQ(larger.exit_code, 3);
  EXPECT_THAT(larger.err, HasSubstr("sky-front.exr has 48 x 27 pixels, the page has 48 x 28"));
  EXPECT_FALSE(std::filesystem::exists(file("cache"))) << "found before tracing";
  const test::Outcome outcome = must_run_here(report + " --height 27 --images " + file("theirs"));
  EXPECT_THAT(outcome.out, HasSubstr("index.html"));
  EXPECT_THAT(outcome.err, HasSubstr("sky.json: not on the page by published scheme (sh2)"));
  EXPECT_THAT(outcome.err, HasSubstr("a sky"));
  const std::string html = test::read_file(file("page/index.html"));
  for (const char* part : {"</html>", "--preset best", "<td>sky-front</td><td>clpv</td>",
                           "<td>sky-front</td><td>theirs</td>"})
    EXPECT_TRUE(html.find(part) != std::string::npos) << part;
  EXPECT_EQ(html.find("<td>published scheme"), std::string::npos);
}

using LongDrawing = Drawing;
TEST_F(LongDrawing, AReportHasThePublishedScheme) {
  const test::Outcome outcome =
      must_run_here("report " + file("page") + " " + test::kTinyRoom +
                    " --width 48 --height 27 --spp 4 --cache " + file("cache"));
  const std::string html = test::read_file(file("page/index.html"));
  for (const char* part :
       {"<td>published scheme (sh2)</td>", "<td>published scheme (srbf8v2)</td>"})
    EXPECT_TRUE(html.find(part) != std::string::npos) << part;
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
  folder_.write("page/index.html", "<html>mine</html>");
  const test::Outcome foreign = run_here("report " + file("page") + " " + test::kTinyRoom);
  EXPECT_EQ(foreign.exit_code, 1);
  EXPECT_THAT(foreign.err, HasSubstr("page/index.html: found a file that clpv did not write"));
  EXPECT_EQ(test::read_file(file("page/index.html")), "<html>mine</html>");
}

}  // namespace
}  // namespace clpv::drawing_test
