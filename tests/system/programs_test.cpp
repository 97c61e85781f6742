// SPDX-License-Identifier: MIT
// Programs that clpv starts: none comes from the current folder, and file names are no options of
// theirs (docs/security.md).

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <filesystem>

#include "tests/support/run_here.hpp"
#include "tests/support/run_program.hpp"
#include "tests/support/scenes.hpp"

namespace clpv::programs_test {

namespace fs = std::filesystem;
using test::kSmallSteps;
using test::kTiny;
using test::read_file;
using ::testing::HasSubstr;

/// A folder with a trap of every name that Python or a program search could take from it. Each
/// writes a file "sprung".
class Traps {
 public:
  Traps() {
    const std::string sprung = (folder_ / "sprung").string();
    for (const char* file : {"clpv/__init__.py", "clpv/draw/__init__.py", "clpv/draw/__main__.py",
                             "jinja2.py", "markupsafe.py", "matplotlib.py", "numpy.py", "json.py",
                             "sitecustomize.py", "usercustomize.py"}) {
      folder_.write(file,
                    "open('" + sprung + "', 'a').write('" + file + "\\n')\nraise SystemExit(0)\n");
    }
    for (const char* file :
         {"python3", "python", "env", "sh", "ffmpeg", "ld", "cc", "clang", "mpirun", "clpv"}) {
      folder_.write(file, "#!/bin/sh\necho " + std::string(file) + " >>" + sprung + "\n");
      ::chmod((folder_ / file).c_str(), 0755);
    }
    folder_.write("matplotlibrc", "axes.labelsize: no size\n");  // a warning, were it read
  }
  /// `clpv arguments` in the folder, with the current folder in PATH in all its spellings.
  test::Outcome run(const std::string& arguments, const std::string& variables = "") const {
    return test::run("cd " + folder_.path().string() + " && PYTHONPATH=. PATH=.::./:\"$PATH\": " +
                     variables + " " CLPV_PROGRAM " " + arguments);
  }
  std::string sprung() const { return read_file(folder_ / "sprung"); }
  const test::TemporaryFolder& folder() const { return folder_; }

 private:
  test::TemporaryFolder folder_;
};

TEST(Programs, NothingOfTheCurrentFolderRuns) {
  const Traps traps;
  for (const std::string& command :
       {"quality " + kTiny + kSmallSteps + "--spp 1 --frames 1 --cache cache -o q.json",
        std::string("report page --quality q.json"),
        "sequence " + kTiny + kSmallSteps + "--frames 1 --fps 1 -o film --video -v.mp4"}) {
    const test::Outcome outcome = traps.run(command);
    const bool no_ffmpeg = outcome.err.find("--video needs ffmpeg") != std::string::npos;
    EXPECT_EQ(outcome.exit_code, no_ffmpeg ? 1 : 0) << command << "\n" << outcome.err;
    EXPECT_EQ(traps.sprung(), "") << command;
    EXPECT_THAT(outcome.err, testing::Not(HasSubstr("labelsize")));
  }
  EXPECT_TRUE(fs::exists(traps.folder() / "page/index.html"));
}

TEST(Programs, HelpersAndCompilersOfTheCurrentFolderDoNotRun) {
  const Traps traps;
  fs::create_directory(traps.folder() / "pocl");
  const test::Outcome outcome = traps.run("check --stage sizes,emit",
                                          "XDG_CACHE_HOME=cache POCL_CACHE_DIR=$PWD/pocl TMPDIR=.");
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_EQ(traps.sprung(), "");
}

// A python3 without NumPy that comes first in PATH (pyenv, conda) once ended `clpv report`.
TEST(Programs, APythonThatLacksModulesIsPassedOver) {
  const test::TemporaryFolder folder;
  folder.write("bin/python3", "#!/bin/sh\necho No module named numpy >&2\nexit 1\n");
  ::chmod((folder / "bin/python3").c_str(), 0755);
  const std::string report = CLPV_PROGRAM " report " + (folder / "page").string() + " --quality " +
                             folder.write("q.json", R"({"variants": []})").string();
  const test::Outcome passed = test::run("PATH=" + (folder / "bin").string() + ":$PATH " + report);
  EXPECT_EQ(passed.exit_code, 0) << passed.err;
  const test::Outcome named =
      test::run("CLPV_PYTHON=" + (folder / "bin/python3").string() + " " + report);
  EXPECT_EQ(named.exit_code, 1);
  EXPECT_THAT(named.err, testing::AllOf(HasSubstr("CLPV_PYTHON"), HasSubstr("python3-matplotlib"),
                                        HasSubstr((folder / "bin/python3").string() +
                                                  ": No module named numpy")));
}

// Python and daemons may ignore SIGCHLD. The first frame then waited without end, and an ffmpeg
// that had failed replaced the film by nothing.
TEST(Programs, AParentThatIgnoresSIGCHLDChangesNothing) {
  const test::TemporaryFolder folder;
  folder.write("bin/ffmpeg", "#!/bin/sh\ncat >/dev/null\nexit 3\n");
  ::chmod((folder / "bin/ffmpeg").c_str(), 0755);
  folder.write("film.mp4", "old");
  const std::string ignoring = "cd " + folder.path().string() +
                               " && PATH=" + (folder / "bin").string() +
                               ":$PATH exec timeout -s KILL 300 "  // which resets SIGCHLD
                               "env --ignore-signal=CHLD --block-signal=TERM " CLPV_PROGRAM;
  const test::Outcome film = test::run(ignoring + " sequence " + kTiny + kSmallSteps +
                                       "--frames 1 --fps 1 -o frames --video film.mp4");
  EXPECT_EQ(film.exit_code, 1) << film.err;
  EXPECT_THAT(film.err, HasSubstr("ffmpeg ended with 3"));
  EXPECT_EQ(read_file(folder / "film.mp4"), "old");
  const test::Outcome checked = test::run(ignoring + " check --stage sizes,emit");
  EXPECT_EQ(checked.exit_code, 0) << checked.err;
}

TEST(Programs, ANameWithAColonOrADashIsAFileToFfmpeg) {
  const test::TemporaryFolder folder;
  // Instead of ffmpeg: writes its arguments where the last one says.
  folder.write("bin/ffmpeg",
               "#!/bin/sh\ncat >/dev/null\nfor last; do :; done\necho \"$*\" >\"${last#file:}\"\n");
  ::chmod((folder / "bin/ffmpeg").c_str(), 0755);
  for (const std::string& name :
       {std::string("tcp:x.mp4"), std::string("-y.mp4"), std::string(251, 'a') + ".mp4"}) {
    const test::Outcome outcome =
        test::run("cd " + folder.path().string() + " && PATH=" + (folder / "bin").string() +
                  ":$PATH " + CLPV_PROGRAM " sequence " + kTiny + kSmallSteps +
                  "--frames 1 --fps 1 -o film --video=" + name);
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
    EXPECT_THAT(read_file(folder / name), HasSubstr(" file:/")) << name;
  }
}

// `clpv report` and its errors. tests/draw has the charts and the page.

using test::must_run_here;
using test::run_here;

struct Drawing : ::testing::Test {
  std::string file(const std::string& name) const { return (folder_.path() / name).string(); }

  test::TemporaryFolder folder_;
};

/// A box under a sky, which the published scheme does not have.
struct SkyReport : Drawing {
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

}  // namespace clpv::programs_test
