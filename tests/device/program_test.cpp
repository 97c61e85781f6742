// SPDX-License-Identifier: MIT
// Kernel text: embedded files, includes, the folder that overrides them, and build errors.
#include "device/program.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>

#include "device/kernel.hpp"
#include "device/kernel_files.hpp"
#include "device/session.hpp"
#include "tests/support/error_of.hpp"
#include "tests/support/run_program.hpp"
#include "tests/support/variable.hpp"

namespace clpv::program_test {
namespace {

using ::testing::HasSubstr;

/// A folder of kernel files that CLPV_KERNEL_DIR names while this lives.
class KernelFolder {
 public:
  void write(const std::string& name, const std::string& text) { folder_.write(name, text); }

 private:
  test::TemporaryFolder folder_;
  const test::Variable variable_{"CLPV_KERNEL_DIR", folder_.path().string()};
};

TEST(KernelFiles, EveryFileIsEmbeddedByteForByte) {
  const std::filesystem::path root = std::filesystem::path(CLPV_SOURCE_DIR) / "kernels";
  std::size_t count = 0;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(root)) {
    if (entry.path().extension() != ".cl" && entry.path().extension() != ".h") continue;
    const std::string name = std::filesystem::relative(entry.path(), root).generic_string();
    EXPECT_EQ(kernel_file(name), test::read_file(entry.path())) << name;
    ++count;
  }
  EXPECT_EQ(detail::embedded_kernel_files().size(), count);
}

TEST(KernelFiles, IncludesAreReplacedAndMarked) {
  KernelFolder folder;
  folder.write("a.cl", "a1\n#include \"b.h\"\n  #include \"shared/b.h\"\na4\n");
  folder.write("b.h", "b1\n");
  folder.write("shared/b.h", "#include \"b.h\"\ns2");
  EXPECT_EQ(
      assemble_kernel_source("a.cl"),
      "#line 1 \"a.cl\"\na1\n"
      "#line 1 \"b.h\"\nb1\n#line 3 \"a.cl\"\n"
      "#line 1 \"shared/b.h\"\n#line 1 \"b.h\"\nb1\n#line 2 \"shared/b.h\"\ns2\n#line 4 \"a.cl\"\n"
      "a4\n");
}

TEST(KernelFiles, FolderOverridesFileByFile) {
  KernelFolder folder;
  folder.write("sizes.cl", "// mine\n#include \"shared/grid.h\"\n");
  EXPECT_EQ(kernel_file("sizes.cl"), "// mine\n#include \"shared/grid.h\"\n");
  EXPECT_THAT(assemble_kernel_source("sizes.cl"), HasSubstr("} ClpvGrid;"))
      << "the rest stays embedded";
}

TEST(KernelFiles, UnknownAndEndlessOnesAreRejected) {
  EXPECT_THROW(kernel_file("no_such.cl"), Error);
  KernelFolder folder;
  folder.write("loop.cl", "#include \"loop.cl\"\n");
  EXPECT_THROW(assemble_kernel_source("loop.cl"), Error);
}

TEST(Literals, OneNameHasOneValue) {
  Literals literals;
  literals.flag("CLPV_ON", true);
  EXPECT_THROW(literals.integer("CLPV_ON", 1), Error);
  EXPECT_THROW(literals.flag("ON", true), Error);
}

TEST(ProgramErrors, BuildFailureShowsLogOptionsAndTheLine) {
  KernelFolder folder;
  folder.write("broken.h", "// one\nint half_done(int a) {\n  return a + no_such_name;\n}\n");
  folder.write(
      "broken.cl",
      "#include \"broken.h\"\n__kernel void k(__global int* a) { a[0] = half_done(CLPV_X); }\n");
  Session session(choose_device());
  const std::string message = test::error_of(ExitCode::run_time, [&] {
    const Kernel kernel(session, {"broken.cl", Literals().integer("CLPV_X", 1)}, "k");
    session.programs().build_described();
  });
  for (const std::string& words :
       {std::string("kernels/broken.cl"), std::string("-cl-std=CL1.2"), session.device().name,
        std::string("no_such_name"), std::string("broken.h:3:")})
    EXPECT_THAT(message, HasSubstr(words));
}

}  // namespace
}  // namespace clpv::program_test
