// SPDX-License-Identifier: MIT
// Capsules: folders that replay a comparison by a program in C. Rows of all kinds replay, and fail
// once a constant of their programs is another; damaged ones are rejected by line.
#include "verify/capsules.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <regex>

#include "device/recorder.hpp"
#include "tests/support/error_of.hpp"
#include "tests/support/run_program.hpp"

namespace clpv::capsules_test {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::StartsWith;

struct Row {
  Stage stage;
  const char* name;
};

/// Every kind of output: floats, halves, integers and bits, of volumes, images and pixels.
constexpr Row kRows[] = {
    {Stage::sizes, "shared structs"},
    {Stage::rasterize, "camera/soup"},
    {Stage::emit, "plain"},
    {Stage::inject, "srbf8v2/light/orthographic"},
    {Stage::blockers, "soa/half"},
    {Stage::visibility, "triangles"},
    {Stage::propagate, "sh2/sampled/areas"},
    {Stage::propagate, "sh2/sampled/blockers/image/half"},
    {Stage::gather, "srbf4/sampled/table image"},
    {Stage::shade, "spot"},
};

verify::Case case_of(const Row& row) {
  for (verify::Case& c : verify::cases_of(row.stage))
    if (c.name == row.name) return c;
  throw std::runtime_error(std::string("no case ") + row.name);
}

/// Records a row; returns its capsule.
fs::path capsule_of(const Row& row, const fs::path& folder) {
  const verify::Case c = case_of(row);
  const Device device = choose_device();
  verify::Capsules capsules(folder);
  capsules.begin(c);
  Session session(device);
  session.record(verify::Capsules::recording_of(folder, c));
  const verify::CheckResults results = verify::run_case(c, session);
  for (const verify::CheckResult& result : results)
    EXPECT_TRUE(result.passed()) << row.name << ": " << result.reason;
  return capsules.finish(c, device, results, results);
}

std::uintmax_t bytes_of(const fs::path& folder) {
  std::uintmax_t bytes = 0;
  for (const auto& entry : fs::directory_iterator(folder)) bytes += entry.file_size();
  return bytes;
}

/// replay, built from the repository's file, and a small capsule.
class Replay : public ::testing::Test {
 protected:
  void SetUp() override {
    const fs::path source = fs::path(CLPV_SOURCE_DIR) / "host/verify/replay";
    fs::copy(source, folder_ / "build");
    const test::Outcome made = test::run("make -s CFLAGS='-O1 -pedantic -Werror' -C " +
                                         (folder_ / "build").string() + " replay");
    ASSERT_EQ(made.exit_code, 0) << made.err;
    folder_.write("small/a.cl",
                  "__kernel void twice(__global float* a, float b) { a[get_global_id(0)] *= b; }\n"
                  "__kernel void endless(__global volatile float* a, float b) {\n"
                  "  while (a[0] != 7.0f) a[1] = b;\n}\n");
    const float values[] = {1, 2, 3, 4}, ranges[] = {2, 2, 4, 4, 6, 6, 8, 8};
    folder_.write("small/in", {reinterpret_cast<const char*>(values), sizeof values});
    folder_.write("small/out", {reinterpret_cast<const char*>(ranges), sizeof ranges});
    capsule(kSmall);
  }
  void capsule(const std::string& commands) { folder_.write("small/capsule.txt", commands); }

  test::Outcome replay(const fs::path& capsule, const std::string& more = {},
                       const std::string& before = {}) const {
    return test::run(before + " " + (folder_ / "build/replay").string() + " " + capsule.string() +
                     " " + more);
  }
  test::Outcome replay() const { return replay(folder_ / "small"); }

  static constexpr const char* kSmall =
      "buffer 0 16\nwrite 0 in\nprogram 0 a.cl -cl-std=CL1.2\n"
      "launch 0 twice 1 4 2 m0 v00000040\nexpect 0 float out\n";
  const test::TemporaryFolder folder_;
};

/// Replaces one float constant of a capsule's texts after another until the result is wrong.
bool fails_with_another_constant(const fs::path& capsule,
                                 const std::function<test::Outcome()>& replay) {
  const std::regex constant(R"(\b(\d+)\.(\d+)f\b|float origin\[3\])");
  for (const auto& entry : fs::directory_iterator(capsule)) {
    if (entry.path().extension() != ".cl") continue;
    const std::string text = test::read_file(entry.path());
    std::vector<std::smatch> found{std::sregex_iterator(text.begin(), text.end(), constant), {}};
    std::ranges::reverse(found);
    if (found.size() > 8) found.resize(8);
    for (const std::smatch& match : found) {
      const std::string other = match[1].matched ? match[1].str() + "7." + match[2].str() + "f"
                                                 : "float origin[4]";
      std::string changed = text;
      changed.replace(match.position(), match.length(), other);
      std::ofstream(entry.path()) << changed;
      const test::Outcome outcome = replay();
      std::ofstream(entry.path()) << text;
      if (outcome.exit_code == 1 && outcome.out.find("\nwrong: ") != std::string::npos) return true;
    }
  }
  return false;
}

TEST_F(Replay, RowsOfAllKindsAreOkAndWrongWithAnotherConstant) {
  for (const Row& row : kRows) {
    SCOPED_TRACE(row.name);
    const fs::path capsule =
        capsule_of(row, folder_ / ("rows" + std::to_string(&row - std::begin(kRows))));
    EXPECT_LE(bytes_of(capsule), Recorder::kMaxBytes + (64 << 10));
    const test::Outcome outcome = replay(capsule);
    EXPECT_EQ(outcome.exit_code, 0) << outcome.out;
    EXPECT_THAT(outcome.out, HasSubstr("\nok: "));
    EXPECT_TRUE(fails_with_another_constant(capsule, [&] { return replay(capsule); }));
  }
}

TEST_F(Replay, ACapsuleIsCleanUnderOclgrind) {
  if (test::run("oclgrind --version").exit_code != 0)
    GTEST_SKIP() << "oclgrind is not installed (Debian: apt install oclgrind)";
  const fs::path capsule = capsule_of({Stage::blockers, "soa/half"}, folder_ / "rows");
  const std::string log = (folder_ / "log").string();
  const test::Outcome outcome =
      replay(capsule, "",
             "oclgrind --data-races --uninitialized --build-options "
             "'-cl-opt-disable -Dalways_inline=noinline' --log " + log);
  EXPECT_EQ(outcome.exit_code, 0) << outcome.out << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr("\nok: "));
  EXPECT_EQ(test::read_file(log), "");
}

TEST_F(Replay, PrintsTheFirstWrongPlace) {
  EXPECT_EQ(replay().exit_code, 0);
  folder_.write("small/a.cl",
                "__kernel void twice(__global float* a, float b) { a[get_global_id(0)] *= "
                "get_global_id(0) < 2 ? b : 1; }\n");
  const test::Outcome outcome = replay();
  EXPECT_EQ(outcome.exit_code, 1);
  EXPECT_THAT(outcome.out,
              HasSubstr("wrong: memory 0, element 2: 3, expected 6, tolerance 0; 2 of 4 elements"));
}

TEST_F(Replay, AKernelThatNeverEndsFails) {
  capsule(
      "buffer 0 16\nwrite 0 in\nprogram 0 a.cl\nlaunch 0 endless 1 1 1 m0 v00000040\n");
  const test::Outcome outcome = replay(folder_ / "small", "", "REPLAY_SECONDS=1");
  EXPECT_EQ(outcome.exit_code, 1);
  EXPECT_THAT(outcome.out, HasSubstr("failed: ended by signal 14 (14: did not end within"));
}

TEST_F(Replay, NamesDamagedLines) {
  const std::string before = "buffer 0 16\nwrite 0 in\nprogram 0 a.cl\n";
  const std::pair<std::string, std::string> kDamaged[] = {
      {"{\"json\": 1}", "capsule.txt:1: found '{\"json\":', allowed: buffer, image3d"},
      {"buffer 0", "capsule.txt:1: found the end of the line, allowed: bytes"},
      {"buffer 0 -1", "capsule.txt:1: found '-1', allowed: bytes"},
      {"buffer 99999 4", "capsule.txt:1: found '99999', allowed: a memory, at most 4095"},
      {"write 3 in", "capsule.txt:1: found memory 3, allowed: one of an earlier line"},
      {"buffer 0 4\nwrite 0 in", "capsule.txt:2: in: found 16 bytes (-1: no file), allowed: at most 4"},
      {"buffer 0 16\nwrite 0 no", "capsule.txt:2: no: found -1 bytes (-1: no file)"},
      {before + "launch 1 twice 1 4 2 m0", "capsule.txt:4: found program 1, allowed"},
      {before + "launch 0 none 1 4 2 m0", "capsule.txt:4: clCreateKernel: error -46"},
      {before + "launch 0 twice 1 4 2 m0 v0000004", "capsule.txt:4: found 'v0000004', allowed"},
      {before + "launch 0 twice 1 4 2 m0", "capsule.txt:4: launching: error -52"},
      {before + "expect 0 double out", "capsule.txt:4: found 'double', allowed: float"},
  };
  for (const auto& [commands, words] : kDamaged) {
    capsule(commands);
    const test::Outcome outcome = replay();
    EXPECT_EQ(outcome.exit_code, 1) << commands;
    EXPECT_THAT(outcome.out, HasSubstr("failed: " + words)) << commands;
  }
  folder_.write("small/a.cl", "__kernel void twice(");
  capsule(kSmall);
  EXPECT_THAT(replay().out, HasSubstr("failed: capsule.txt:3: clBuildProgram with"));
}

TEST_F(Replay, EndsWith77WithoutTheDevice) {
  const test::Outcome outcome = replay(folder_ / "small", "'no such device'");
  EXPECT_EQ(outcome.exit_code, 77);
  EXPECT_THAT(outcome.out, StartsWith("unsupported: "));
}

TEST(Capsules, RejectAFolderWithFiles) {
  const test::TemporaryFolder folder;
  folder.write("mine", "1");
  EXPECT_THAT(test::error_of(ExitCode::usage, [&] { verify::Capsules(folder.path()); }),
              AllOf(HasSubstr(folder.path().string()), HasSubstr("found files; allowed: a new")));
  EXPECT_EQ(std::distance(fs::directory_iterator(folder.path()), {}), 1);
}

TEST(Capsules, LeaveNothingHalfWritten) {
  const test::TemporaryFolder folder;
  const verify::Case c = case_of(kRows[0]);
  {
    verify::Capsules capsules(folder / "new");
    capsules.begin(c);
    const auto failed =
        verify::result_of("sizes", c.name, verify::Status::failed, "capsule: no space");
    EXPECT_THAT(test::error_of(ExitCode::run_time,
                               [&] { capsules.finish(c, choose_device(), {failed}, {failed}); }),
                HasSubstr("sizes-shared-structs: capsule: no space"));
  }
  EXPECT_TRUE(fs::is_empty(folder / "new"));
}

TEST(Capsules, NameAFolderThatCannotBeWritten) {
  Session session(choose_device());
  EXPECT_THAT(test::error_of(ExitCode::run_time, [&] { session.record("/nonexistent/folder"); }),
              StartsWith("capsule: /nonexistent/folder"));
}

/// `clpv check` on one comparison, with capsules in `folder`.
test::Outcome check(const std::string& before, const fs::path& folder, const std::string& more) {
  return test::run(before + " " + test::usual_kernels() + CLPV_PROGRAM +
                   " check --stage sizes --capsules " + folder.string() + " " + more);
}

TEST(Capsules, ACompilerErrorLeavesOneWithoutLaunches) {
  const test::TemporaryFolder folder;
  folder.write("kernels/sizes.cl", "__kernel void sizes(");
  const test::Outcome outcome = check("CLPV_KERNEL_DIR=" + (folder / "kernels").string(),
                                      folder / "capsules", "");
  EXPECT_EQ(outcome.exit_code, 5) << outcome.err;
  const fs::path capsule = folder / "capsules/sizes-shared-structs";
  EXPECT_THAT(outcome.err, HasSubstr("capsule of sizes shared structs: " + capsule.string()));
  EXPECT_THAT(test::read_file(capsule / "capsule.txt"), AllOf(HasSubstr("\nprogram 0 0-sizes.cl "),
                                                              ::testing::Not(HasSubstr("\nlaunch"))));
  EXPECT_THAT(test::read_file(capsule / "README.md"),
              AllOf(HasSubstr("sizes shared structs"), HasSubstr("failed"), HasSubstr("driver ")));
}

TEST(Capsules, OnlyComparisonsThatExistAreNamed) {
  const test::TemporaryFolder folder;
  const test::Outcome passes = check("", folder / "a", "--capsule 'sizes shared structs'");
  EXPECT_EQ(passes.exit_code, 0) << passes.err;
  EXPECT_TRUE(fs::exists(folder / "a/sizes-shared-structs/replay.c"));
  const test::Outcome unknown = check("", folder / "b", "--capsule 'sizes none'");
  EXPECT_EQ(unknown.exit_code, 2);
  EXPECT_THAT(unknown.err, HasSubstr("--capsule sizes none: no comparison has that name; allowed"));
  EXPECT_FALSE(fs::exists(folder / "b"));
}

}  // namespace
}  // namespace clpv::capsules_test
