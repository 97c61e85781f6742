// SPDX-License-Identifier: MIT
// Capsules: folders that replay a comparison by a program in C. Rows of all kinds replay, and fail
// once a constant of their programs is another; damaged ones are rejected by line.
#include "verify/capsules.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstring>

#include "device/recorder.hpp"
#include "tests/support/error_of.hpp"
#include "tests/support/run_program.hpp"

namespace clpv::capsules_test {
namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::StartsWith;

struct Row {
  Stage stage;
  const char* name;
  const char *text, *other;  ///< a constant of its programs with its surroundings, another one
};

// Integers, halves of a volume, and pixels.
const Row kRows[] = {
    {Stage::sizes, "shared structs", "float origin[3]", "float origin[4]"},
    {Stage::blockers, "soa/half", "(1.0f / 64.0f)", "(1.0f / 32.0f)"},
    {Stage::shade, "spot", "shown.z, 1.0f", "shown.z, 2.0f"},
};
// The other kinds of outputs: floats and bits, of volumes and images.
const Row kLongRows[] = {
    {Stage::rasterize, "camera/soup", "1.0f / facing", "2.0f / facing"},
    {Stage::inject, "sh2/light/orthographic", "z += shift", "z += shift + 1"},
    {Stage::visibility, "triangles", "cube + 0.5f - v0", "cube + 2.5f - v0"},
    {Stage::propagate, "sh2/sampled/blockers/image/half", "arriving[n] = 0.0f",
     "arriving[n] = 1.0f"},
    {Stage::gather, "srbf4/sampled/table image", "sums[i] = 0.0f", "sums[i] = 1.0f"},
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

/// Replaces the constant of a row in its capsule.
void alter(const Row& row, const fs::path& capsule) {
  for (const auto& entry : fs::directory_iterator(capsule)) {
    if (entry.path().extension() != ".cl") continue;
    std::string text = test::read_file(entry.path());
    const std::size_t at = text.find(row.text);
    if (at == std::string::npos) continue;
    text.replace(at, std::strlen(row.text), row.other);
    std::ofstream(entry.path()) << text;
    return;
  }
  ADD_FAILURE() << "no program has '" << row.text << "'";
}

/// replay, built from the repository's file, and a small capsule.
struct Replay : ::testing::Test {
  void SetUp() override {
    ASSERT_TRUE(fs::exists(program()));
    folder_.write("small/a.cl",
                  "__kernel void twice(__global float* a, float b) { a[get_global_id(0)] *= b; }\n"
                  "__kernel void endless(__global volatile float* a, float b) {\n"
                  "  while (a[0] != 7.0f) a[1] = b;\n}\n");
    const float values[] = {1, 2, 3, 4}, ranges[] = {2, 2, 4, 4, 6, 6, 8, 8};
    folder_.write("small/in", {reinterpret_cast<const char*>(values), sizeof values});
    folder_.write("small/out", {reinterpret_cast<const char*>(ranges), sizeof ranges});
    capsule(kSmall);
  }
  /// The program, built by the first test of the process.
  static fs::path program() {
    static const test::TemporaryFolder folder;
    static const test::Outcome made = [] {
      fs::copy(fs::path(CLPV_SOURCE_DIR) / "host/verify/replay", folder / "build");
      return test::run("make -s CFLAGS='-O1 -pedantic -Werror' -C " + (folder / "build").string() +
                       " replay");
    }();
    EXPECT_EQ(made.exit_code, 0) << made.err;
    return folder / "build/replay";
  }

  void capsule(const std::string& commands) { folder_.write("small/capsule.txt", commands); }

  test::Outcome replay(const fs::path& capsule, const std::string& more = {},
                       const std::string& before = {}) const {
    return test::run(before + " " + program().string() + " " + capsule.string() + " " + more);
  }
  test::Outcome replay() const { return replay(folder_ / "small"); }

  /// A capsule of the row is ok, and wrong with another constant.
  void expect_judged(const Row& row) {
    SCOPED_TRACE(row.name);
    const fs::path capsule = capsule_of(row, folder_ / ("rows" + std::to_string(rows_++)));
    EXPECT_LE(bytes_of(capsule), Recorder::kMaxBytes + (64 << 10));
    const test::Outcome outcome = replay(capsule);
    EXPECT_EQ(outcome.exit_code, 0) << outcome.out;
    EXPECT_THAT(outcome.out, HasSubstr("\nok: "));
    alter(row, capsule);
    const test::Outcome altered = replay(capsule);
    EXPECT_EQ(altered.exit_code, 1) << altered.out;
    EXPECT_THAT(altered.out, HasSubstr("\nwrong: "));
  }

  static constexpr const char* kSmall =
      "buffer 0 16\nwrite 0 in\nprogram 0 a.cl -cl-std=CL1.2\n"
      "launch 0 twice 1 4 2 m0 v00000040\nexpect 0 float out\n";
  const test::TemporaryFolder folder_;
  int rows_ = 0;
};

TEST_F(Replay, MakeCheckReplaysOnTheFirstDeviceOrOneNamed) {
  for (const char* name : {"replay.c", "Makefile"})
    fs::copy(fs::path(CLPV_SOURCE_DIR) / "host/verify/replay" / name, folder_ / "small");
  const std::string check = "make -s check -C " + (folder_ / "small").string();
  const test::Outcome first = test::run(check);
  EXPECT_EQ(first.exit_code, 0) << first.out << first.err;
  EXPECT_THAT(first.out, HasSubstr("ok: 1 launches"));
  EXPECT_THAT(test::run(check + " DEVICE=nowhere").err, HasSubstr("Error 77"));
}

TEST_F(Replay, RowsAreOkAndWrongWithAnotherConstant) {
  for (const Row& row : kRows) expect_judged(row);
}

using LongReplay = Replay;
TEST_F(LongReplay, RowsOfAllKindsAreOkAndWrongWithAnotherConstant) {
  for (const Row& row : kLongRows) expect_judged(row);
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
  capsule("buffer 0 16\nwrite 0 in\nprogram 0 a.cl\nlaunch 0 endless 1 1 1 m0 v00000040\n");
  const test::Outcome outcome = replay(folder_ / "small", "", "REPLAY_SECONDS=1");
  EXPECT_EQ(outcome.exit_code, 1);
  EXPECT_THAT(outcome.out, HasSubstr("failed: ended by signal 14 (14: did not end within"));
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
  const test::Outcome outcome =
      check("CLPV_KERNEL_DIR=" + (folder / "kernels").string(), folder / "capsules", "");
  EXPECT_EQ(outcome.exit_code, 5) << outcome.err;
  const fs::path capsule = folder / "capsules/sizes-shared-structs";
  EXPECT_THAT(outcome.err, HasSubstr("capsule of sizes shared structs: " + capsule.string()));
  EXPECT_THAT(test::read_file(capsule / "capsule.txt"),
              AllOf(HasSubstr("\nprogram 0 0-sizes.cl "), ::testing::Not(HasSubstr("\nlaunch"))));
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

}  // namespace clpv::capsules_test
