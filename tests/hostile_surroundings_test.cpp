// SPDX-License-Identifier: MIT
// Surroundings that are against it: folders that may not be written, outputs in the way, variables that lead nowhere. And
// caches that hold anything at all, which must not matter.
#include <sys/stat.h>
#include <unistd.h>

#include "tests/support/hostile.hpp"

namespace clpv::test::hostile_surroundings_test {
namespace {

namespace fs = std::filesystem;

/// A frame of a few pixels, compiled anew.
const std::string kTiny =
    "render " CLPV_SOURCE_DIR
    "/tests/oclgrind/tiny.gltf --width 12 --height 9 --grid 5 --cascades 1 --cascade-size 5 "
    "--rsm-size 8 --shadow-size 8 --basis sh2 --transport sampled --gather all --blockers seen ";
const std::string kCornell = CLPV_SOURCE_DIR "/scenes/cornell.json";

TEST(HostileSurroundings, Outputs) {
  const auto rejected = [](const std::string& command, const std::vector<std::string>& words) {
    expect_rejected({command, command, 1, words, {{"file", ""}}, [](const TemporaryFolder& folder) {
                       fs::create_directories(folder / "folder.exr");
                       fs::create_symlink("/dev/null", folder / "null.exr");
                       fs::create_symlink("none/at/all.exr", folder / "link.exr");
                     }});
  };
  rejected(kTiny + "-o @/none/a.exr", {"none/a.exr", "no folder"});
  rejected(kTiny + "-o @/folder.exr", {"folder.exr", "folder"});
  rejected(kTiny + "-o @/null.exr", {"null.exr", "not a regular file"});
  rejected(kTiny + "-o @/link.exr", {"link.exr"});
  rejected(kTiny + "-o @/" + std::string(300, 'a') + ".exr", {"cannot be written"});
  rejected(kTiny + "-o @/out.exr --stats @/none/s.json", {"none/s.json"});
  rejected(kTiny + "-o @/out.exr --dump-normals @/none/n.json", {"none/n.json"});
  rejected(kTiny + "-o @/out.exr --dump-volume @/file", {"file"});
  rejected("bench ceilings --out @/none/r.json", {"none/r.json"});
  rejected("compare a.exr b.exr -o @/none/out.png", {"none/out.png"});
  rejected("propagate --at 4,4,4 --grid 8 -o @/none/a.npy", {"none/a.npy"});
}

TEST(HostileSurroundings, Variables) {
  const auto rejected = [](const std::string& variables, int code, const std::vector<std::string>& words) {
    expect_rejected({variables,
                     kTiny + "-o @/out.exr",
                     code,
                     words,
                     {{"file", ""}, {"k/rasterize.cl", "nonsense\n"}},
                     {},
                     variables});
  };
  rejected("CLPV_PROGRAM_CACHE=off CLPV_PROGRAM_DUMP=@/none", 1, {"none/", "there is no folder"});
  rejected("CLPV_PROGRAM_CACHE=off CLPV_KERNEL_DIR=@/k", 1, {"does not build"});
  rejected("env -u POCL_CACHE_DIR XDG_CACHE_HOME=@/file", 4, {"no OpenCL device found", "POCL_CACHE_DIR"});
}

/// The program for someone who is not root, for whom permissions count; empty where that cannot be had.
std::string as_nobody() {
  if (::geteuid() != 0) return " ";
  const std::string become = "setpriv --reuid=65534 --regid=65534 --clear-groups ";
  return run(become + CLPV_PROGRAM " --version").exit_code == 0 ? become : "";
}

TEST(HostileSurroundings, Permissions) {
  const std::string nobody = as_nobody();
  if (nobody.empty()) GTEST_SKIP() << "root, and no setpriv to become someone else: permissions bind nobody";
  const auto locked = [&](const std::string& command, int code, const char* file, mode_t mode,
                          const char* inside = nullptr) {
    const auto lock = [=](const TemporaryFolder& folder) {
      ::chmod(folder.path().c_str(), 0755);
      ::chmod((folder / file).c_str(), mode);
    };
    const char* made = inside != nullptr ? inside : file;
    const char* words = code == 1 ? "Permission denied" : "cannot be read";
    expect_rejected({command, command, code, {file, words}, {{made, "{}"}}, lock, nobody});
  };
  locked(kTiny + "-o @/f/a.exr", 1, "f", 0555, "f/x");
  locked(kTiny + "-o @/a.exr", 1, "a.exr", 0444);
  locked("render @/m.gltf -o /tmp/out.exr", 3, "m.gltf", 0);
  locked("compare @/a.exr @/a.exr", 3, "a.exr", 0);
  locked("bench ceilings --compare @/o.json", 3, "o.json", 0);
}

/// A command that needs few programs.
const std::string kFew = "propagate --grid 5 --iterations 2 --at 2,2,2 ";

/// A run that must go well whatever its caches hold, with the light that it finds without any.
void expect_the_same_light(const std::string& name, const std::string& surroundings,
                           const std::function<void(const TemporaryFolder&)>& prepare) {
  SCOPED_TRACE(name);
  static const std::string wanted = [] {
    const TemporaryFolder folder;
    run(usual_kernels() + "CLPV_PROGRAM_CACHE=off " CLPV_PROGRAM " " + kFew + "-o " +
        (folder / "a.npy").string());
    return read_file(folder / "a.npy");
  }();
  ASSERT_FALSE(wanted.empty());
  const TemporaryFolder folder;
  if (prepare) prepare(folder);
  const Outcome outcome = run(usual_kernels() + with_folder(surroundings, folder) + " " + kPatience +
                              CLPV_PROGRAM + " " + with_folder(kFew + "-o @/a.npy", folder));
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_TRUE(read_file(folder / "a.npy") == wanted) << "other light";
}

TEST(HostileSurroundings, CachesDoNotMatter) {
  const std::string cache = "CLPV_PROGRAM_CACHE= XDG_CACHE_HOME=@/cache";
  expect_the_same_light("no home at all", "env -u HOME -u XDG_CACHE_HOME CLPV_PROGRAM_CACHE=", {});
  expect_the_same_light("a file for a home", "CLPV_PROGRAM_CACHE= XDG_CACHE_HOME=@/file",
                        [](const TemporaryFolder& folder) { folder.write("file", ""); });
  // Each file of a cache that a run has filled is damaged in a way of its own.
  expect_the_same_light("a cache of rubbish", cache, [](const TemporaryFolder& folder) {
    const Outcome once =
        run(usual_kernels() + with_folder("CLPV_PROGRAM_CACHE= XDG_CACHE_HOME=@/cache " CLPV_PROGRAM " " +
                                              kFew + "-o @/first.npy",
                                          folder));
    EXPECT_EQ(once.exit_code, 0) << once.err;
    int damaged = 0;
    for (const auto& entry :
         std::vector<fs::directory_entry>(fs::directory_iterator(folder / "cache/clpv"), {})) {
      const fs::path& file = entry.path();
      switch (damaged++ % 4) {
        case 0:
          std::ofstream(file, std::ios::binary) << std::string(5000, 'x');
          break;
        case 1:
          fs::resize_file(file, fs::file_size(file) / 2);
          break;
        case 2:
          fs::remove(file);
          fs::create_directories(file / "below");
          break;
        case 3:
          fs::remove(file);
          fs::create_symlink(file.filename(), file);
      }
    }
    EXPECT_GT(damaged, 0) << "nothing was kept";
  });
}

}  // namespace
}  // namespace clpv::test::hostile_surroundings_test
