// The report: its pictures and charts, the page as a whole, and `clpv report`.
#include "report/report.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "report/chart.hpp"
#include "report/picture.hpp"
#include "support/error.hpp"
#include "tests/support/run_program.hpp"

namespace clpv::report {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;

Image uniform(int width, int height, float value) {
  Image image = make_image(width, height, {"R", "G", "B", "A"});
  image.pixels.assign(image.pixels.size(), value);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) image.at(x, y, 3) = 1;
  return image;
}

TEST(ReportPicture, IsAPngInsideTheText) {
  Image image = make_image(2, 1, {"R", "G", "B"});
  image.encoding = Encoding::srgb;
  EXPECT_THAT(data_uri(image), StartsWith("data:image/png;base64,iVBORw0KGgo"));  // a PNG's eight first bytes
}

TEST(ReportPicture, FalseColourRunsFromNoErrorToFullScale) {
  const Image truth = uniform(3, 1, 2.0f);
  Image image = uniform(3, 1, 2.0f);
  for (std::size_t c = 0; c < 3; ++c)
    image.at(1, 0, c) = 2 + 2 * 1.5f;  // 1.5 times the truth's root mean square
  image.at(2, 0, 3) = 0;               // background
  const Image colours = false_colour(image, truth, 1.5);
  const Image scale = legend(2, 1);
  for (std::size_t c = 0; c < 3; ++c) {
    EXPECT_FLOAT_EQ(colours.at(0, 0, c), scale.at(0, 0, c));
    EXPECT_FLOAT_EQ(colours.at(1, 0, c), scale.at(1, 0, c));
  }
  EXPECT_NE(scale.at(0, 0, 0), scale.at(1, 0, 0));
  EXPECT_EQ(colours.at(0, 0, 3), 1);
  EXPECT_EQ(colours.at(2, 0, 3), 0);
}

TEST(ReportPicture, BlackTruthHasNoScale) {
  const Image colours = false_colour(uniform(1, 1, 1), uniform(1, 1, 0), 1.5);
  EXPECT_FLOAT_EQ(colours.at(0, 0, 0), legend(2, 1).at(0, 0, 0));
}

TEST(ReportChart, MarksTheFrontAndEscapesNames) {
  const std::string svg = scatter(
      {{1, 50, "cheap", "a", false}, {2, 60, "beaten", "a", false}, {4, 30, "<best>", "b", true}}, "ms", "%");
  EXPECT_THAT(svg, HasSubstr("&lt;best&gt;"));
  EXPECT_THAT(svg, Not(HasSubstr("<best>")));
  const auto front = svg.substr(svg.find("class='front'"));
  const std::string path = front.substr(0, front.find("/>"));
  EXPECT_EQ(std::ranges::count(path, 'V'), 2) << "the beaten point is not on the front: " << path;
}

TEST(ReportChart, BarsCarryTheirValues) {
  EXPECT_THAT(bars({{"propagate", "soa float", 1.25}, {"propagate", "image half", 33}}, "t"),
              testing::AllOf(HasSubstr("1.25"), HasSubstr("33"), HasSubstr("image half")));
  EXPECT_EQ(bars({}, "t"), "");
}

Contents some_contents() {
  Contents contents;
  contents.subtitle = "a <device>";
  contents.views = {
      {"room",
       "left",
       0,
       uniform(4, 4, 1),
       {{"theirs", "--preset paper", uniform(4, 4, 2)}, {"ours", "--preset best", uniform(4, 4, 1.1f)}}}};
  contents.quality = {nlohmann::json::parse(
      R"({"variants": [{"options": {"preset": "paper"}, "refused": 0, "nrmse": 1.2, "worst_nrmse": 1.5, "energy_ratio": 1.9, "frame_ms": 160.0},
                       {"options": {"preset": "best"}, "refused": 0, "nrmse": 0.45, "worst_nrmse": 0.5, "energy_ratio": 1.0, "frame_ms": 170.0}]})")};
  contents.benchmarks = {nlohmann::json::parse(
      R"({"benchmarks": [{"suite": "table1", "stage": "propagate", "basis": "sh2", "lobe": "exact", "cascade": 0, "occlusion": true, "status": "ok", "median": 4.25},
                         {"suite": "layouts", "stage": "gather", "basis": "sh2", "layout": "image", "storage": "half", "status": "unsupported", "reason": "no images"}]})")};
  contents.marked = {"best"};
  return contents;
}

TEST(ReportPage, ShowsErrorsTablesAndNothingFromOutside) {
  const std::string html = page(some_contents());
  EXPECT_THAT(html, HasSubstr("theirs: NRMSE 100.0 %"));  // twice the truth everywhere
  EXPECT_THAT(html, HasSubstr("ours: NRMSE 10.0 %, after the best gain 0.0 %, energy 1.10"));
  EXPECT_THAT(html, HasSubstr("<tr class=\"marked\"><td>best</td><td>45.0 %"));
  EXPECT_THAT(html, HasSubstr("<td>4.25</td>"));
  EXPECT_THAT(html, HasSubstr("no images"));
  EXPECT_THAT(html, HasSubstr("a &lt;device&gt;"));
  EXPECT_THAT(html, Not(HasSubstr("http")));
  EXPECT_THAT(html, Not(HasSubstr("<link")));
}

TEST(ReportPage, SaysWhatIsMissing) {
  const std::string html = page({});
  for (const char* what : {"No views", "--quality FILE", "clpv bench table1", "clpv bench layouts"})
    EXPECT_THAT(html, HasSubstr(what));
}

TEST(ReportPage, RefusesADocumentOfAnotherShape) {
  Contents contents;
  contents.quality = {nlohmann::json::parse(R"({"variants": [{"options": {}}]})")};
  try {
    page(contents);
    FAIL() << "accepted";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ExitCode::bad_input);
  }
}

class ReportCommand : public ::testing::Test {
 protected:
  static test::Outcome report(const std::string& arguments) {
    return test::run(std::string(CLPV_PROGRAM) + " report " + arguments);
  }
  std::string file(const std::string& name) const { return (folder_ / name).string(); }

  test::TemporaryFolder folder_;
};

TEST_F(ReportCommand, WritesOnePageWithItsViews) {
  const test::Outcome outcome = report(
      file("page") + " " CLPV_SOURCE_DIR "/scenes/cornell.json --width 48 --height 27 --spp 4 --cache " +
      file("cache"));
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr("index.html"));
  const std::string html = test::read_file(file("page/index.html"));
  EXPECT_THAT(html, HasSubstr("</html>"));
  EXPECT_THAT(html, HasSubstr("--preset best"));
  EXPECT_THAT(html, HasSubstr("clpv: NRMSE"));
}

TEST_F(ReportCommand, RefusesWithItsOwnExitCode) {
  folder_.write("other.json", R"({"schema": 1})");
  folder_.write("file", "");
  const test::Outcome other = report(file("page") + " --quality " + file("other.json"));
  EXPECT_EQ(other.exit_code, 3);
  EXPECT_THAT(other.err, HasSubstr("variants"));
  EXPECT_EQ(report(file("page") + " --bench " + file("absent.json")).exit_code, 3);
  EXPECT_EQ(report(file("file/page")).exit_code, 1);
  EXPECT_EQ(report("").exit_code, 2);
  EXPECT_FALSE(std::filesystem::exists(file("page/index.html")));
}

}  // namespace
}  // namespace clpv::report
