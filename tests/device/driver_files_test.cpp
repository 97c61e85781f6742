// SPDX-License-Identifier: MIT
// `clpv devices` names drivers that cannot be loaded, and lists the others.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include "tests/support/run_program.hpp"

namespace clpv::driver_files_test {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

class DriverFiles : public ::testing::Test {
 protected:
  /// An .icd file with the library of that name in the folder, or elsewhere.
  void add(const std::string& icd, const std::string& library) {
    folder_.write("vendors/" + icd, library + "\n");
  }
  test::Outcome devices(const std::string& more = {}) const {
    return test::run("OCL_ICD_VENDORS=" + (folder_ / "vendors").string() +
                     " timeout 60 " CLPV_PROGRAM " devices " + more);
  }
  /// A library with this code.
  std::string library(const std::string& name, const std::string& code) {
    const std::string file = (folder_ / name).string();
    const auto source = folder_.write(name + ".c", code);
    const test::Outcome built = test::run("cc -shared -o " + file + " " + source.string());
    EXPECT_EQ(built.exit_code, 0) << built.err;
    return file;
  }
  const test::TemporaryFolder folder_;
};

TEST_F(DriverFiles, ThatAreMissingOrForeignAreNamed) {
  std::string foreign = test::read_file("/proc/self/exe").substr(0, 64);
  foreign[18] = 3, foreign[4] = 1;  // a 32-bit file for i386
  add("1-missing.icd", "/nonexistent/libmissing.so");
  add("2-foreign.icd", folder_.write("foreign.so", foreign).string());
  add("3-text.icd", folder_.write("text.so", "no library").string());
  add("4-empty.icd", "");
  add("5-unknown.icd", "libclpv-none.so.7");
  const std::string pipe = (folder_ / "pipe").string();
  ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
  add("6-pipe.icd", pipe);
  add("7-folder.icd", folder_.path().string());
  add("8-other.icd", "libc.so.6");
  const test::Outcome outcome = devices();
  EXPECT_EQ(outcome.exit_code, 4) << outcome.err;
  EXPECT_THAT(
      outcome.out,
      AllOf(HasSubstr("1-missing.icd: /nonexistent/libmissing.so: no such file\n"),
            HasSubstr("2-foreign.icd: " + (folder_ / "foreign.so").string() +
                      ": of another machine; allowed: that of clpv\n"),
            HasSubstr("text.so: no ELF file\n"), HasSubstr("4-empty.icd: names no library\n"),
            HasSubstr("6-pipe.icd: " + pipe + ": no regular file\n"),
            HasSubstr("7-folder.icd: " + folder_.path().string() + ": no regular file\n"),
            HasSubstr("libclpv-none.so.7: cannot open shared object file"),
            HasSubstr("libc.so.6: offers no OpenCL platform\n")));
}

TEST_F(DriverFiles, ThatEndTheProcessAreNamedAndTheOthersListed) {
  for (const auto& entry : std::filesystem::directory_iterator("/etc/OpenCL/vendors"))
    if (entry.path().filename() == "pocl.icd") add("pocl.icd", test::read_file(entry.path()));
  if (!std::filesystem::exists(folder_ / "vendors/pocl.icd"))
    GTEST_SKIP() << "no pocl.icd (Debian: apt install pocl-opencl-icd)";
  add("aborts.icd", library("aborts.so",
                            "#include <stdlib.h>\n"
                            "__attribute__((constructor)) static void start(void) { abort(); }\n"));
  add("exits.icd", library("exits.so",
                           "#include <unistd.h>\n"
                           "__attribute__((constructor)) static void start(void) { _exit(0); }\n"));
  // The loader would wait for a writer.
  ASSERT_EQ(::mkfifo((folder_ / "vendors/pipe.icd").c_str(), 0600), 0);
  const test::Outcome outcome = devices();
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_THAT(outcome.out,
              AllOf(HasSubstr("Portable Computing Language"), HasSubstr("aborts.icd: "),
                    HasSubstr("signal 6"), HasSubstr("exits.icd: "),
                    HasSubstr("with exit code 0 when loaded"),
                    HasSubstr("pipe.icd: names no library"), Not(HasSubstr("pocl.icd"))));
  EXPECT_THAT(devices("--format json").out,
              AllOf(HasSubstr("\"faulty_drivers\": [\n"), HasSubstr("aborts.icd")));
}

}  // namespace
}  // namespace clpv::driver_files_test
