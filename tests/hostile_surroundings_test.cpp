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
  const auto folder_in_the_way = [](const char* name) {
    return [name](const TemporaryFolder& folder) { fs::create_directories(folder / name); };
  };
  expect_all_refused(
      {
          {"a folder that is not there", kTiny + "-o @/none/a.exr", 1, {"none/a.exr", "no folder"}},
          {"a folder in the way",
           kTiny + "-o @/a.exr",
           1,
           {"a.exr", "folder"},
           {},
           folder_in_the_way("a.exr")},
          {"a file for a folder", kTiny + "-o @/file/a.exr", 1, {"file/a.exr"}, {{"file", ""}}},
          {"a device for a file",
           kTiny + "-o @/null.exr",
           1,
           {"null.exr", "not a regular file"},
           {},
           [](const TemporaryFolder& folder) { fs::create_symlink("/dev/null", folder / "null.exr"); }},
          {"a link to nowhere",
           kTiny + "-o @/link.exr",
           1,
           {"link.exr"},
           {},
           [](const TemporaryFolder& folder) { fs::create_symlink("none/at/all.exr", folder / "link.exr"); }},
          {"a link in a circle",
           kTiny + "-o @/link.exr",
           1,
           {"link.exr"},
           {},
           [](const TemporaryFolder& folder) { fs::create_symlink("link.exr", folder / "link.exr"); }},
          {"a name too long", kTiny + "-o @/" + std::string(300, 'a') + ".exr", 1, {"cannot be written"}},
          {"statistics nowhere", kTiny + "-o @/out.exr --stats @/none/s.json", 1, {"none/s.json"}},
          {"normals nowhere", kTiny + "-o @/out.exr --dump-normals @/none/n.json", 1, {"none/n.json"}},
          {"volumes into a file", kTiny + "-o @/out.exr --dump-volume @/file", 1, {"file"}, {{"file", ""}}},
          {"a film into a file",
           "sequence " + kCornell + " -o @/file --frames 2 --fps 1",
           1,
           {"not a folder"},
           {{"file", ""}}},
          {"a report nowhere", "bench ceilings --out @/none/r.json", 1, {"none/r.json"}},
          {"charts into a file", "bench ceilings --plot @/file", 1, {"file"}, {{"file", ""}}},
          {"figures nowhere", "compare a.exr b.exr -o @/none/out.png", 1, {"none/out.png"}},
          {"a table nowhere",
           "query " + kCornell + " --points @/p.csv -o @/none/t.csv",
           1,
           {"none/t.csv"},
           {{"p.csv", "0,0,0,0,1,0\n"}}},
          {"an array nowhere", "propagate --at 4,4,4 --grid 8 -o @/none/a.npy", 1, {"none/a.npy"}},
          {"a truth nowhere", "reference " + kCornell + " -o @/none/t.exr", 1, {"none/t.exr"}},
          {"kernels nowhere",
           kTiny + "-o @/out.exr",
           1,
           {"none/", "cannot be written"},
           {},
           {},
           "CLPV_PROGRAM_CACHE=off CLPV_PROGRAM_DUMP=@/none"},
          {"kernels that are none",
           kTiny + "-o @/out.exr",
           1,
           {"does not build"},
           {{"k/rasterize.cl", "nonsense\n"}},
           {},
           "CLPV_PROGRAM_CACHE=off CLPV_KERNEL_DIR=@/k"},
          {"a driver that has nowhere to write",
           kTiny + "-o @/out.exr",
           4,
           {"no OpenCL device found", "POCL_CACHE_DIR"},
           {{"file", ""}},
           {},
           "XDG_CACHE_HOME=@/file"},
      },
      20);
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
  const auto locked = [](const char* name, mode_t mode) {
    return [name, mode](const TemporaryFolder& folder) {
      ::chmod(folder.path().c_str(), 0755);
      ::chmod((folder / name).c_str(), mode);
    };
  };
  expect_all_refused(
      {
          {"a folder not to be written",
           kTiny + "-o @/f/a.exr",
           1,
           {"f/a.exr", "Permission denied"},
           {{"f/x", ""}},
           locked("f", 0555),
           nobody},
          {"a folder not to be seen",
           kTiny + "-o @/f/a.exr",
           1,
           {"f/a.exr", "Permission denied"},
           {{"f/x", ""}},
           locked("f", 0),
           nobody},
          {"a file not to be written",
           kTiny + "-o @/a.exr",
           1,
           {"a.exr", "denied"},
           {{"a.exr", "old"}},
           locked("a.exr", 0444),
           nobody},
          {"a model not to be read",
           "render @/m.gltf -o /tmp/out.exr",
           3,
           {"m.gltf", "cannot be read"},
           {{"m.gltf", "{}"}},
           locked("m.gltf", 0),
           nobody},
          {"an image not to be read",
           "compare @/a.exr @/a.exr",
           3,
           {"a.exr", "cannot be read"},
           {{"a.exr", "x"}},
           locked("a.exr", 0),
           nobody},
          {"points not to be read",
           "query " + kCornell + " --points @/p.csv",
           3,
           {"p.csv"},
           {{"p.csv", "x"}},
           locked("p.csv", 0),
           nobody},
          {"centres not to be read",
           "basis --centres @/c.json",
           3,
           {"c.json"},
           {{"c.json", "{}"}},
           locked("c.json", 0),
           nobody},
          {"a report not to be read",
           "bench ceilings --compare @/o.json",
           3,
           {"o.json", "cannot be read"},
           {{"o.json", "{}"}},
           locked("o.json", 0),
           nobody},
      },
      8);
}

/// PoCL has a cache of its own, and no device where it cannot write that.
std::string driver_cache() {
  static const TemporaryFolder folder;
  return "POCL_CACHE_DIR=" + folder.path().string() + " ";
}

/// A command that needs few programs.
const std::string kFew = "propagate --grid 5 --iterations 2 --at 2,2,2 ";

/// A run that must go well whatever its caches hold, with the light that it finds without any.
void expect_the_same_light(const std::string& name, const std::string& surroundings,
                           const std::function<void(const TemporaryFolder&)>& prepare) {
  SCOPED_TRACE(name);
  static const std::string wanted = [] {
    const TemporaryFolder folder;
    run(driver_cache() + "CLPV_PROGRAM_CACHE=off " CLPV_PROGRAM " " + kFew + "-o " +
        (folder / "a.npy").string());
    return read_file(folder / "a.npy");
  }();
  ASSERT_FALSE(wanted.empty());
  const TemporaryFolder folder;
  if (prepare) prepare(folder);
  const Outcome outcome = run(driver_cache() + with_folder(surroundings, folder) + " " + kPatience +
                              CLPV_PROGRAM + " " + with_folder(kFew + "-o @/a.npy", folder));
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_TRUE(read_file(folder / "a.npy") == wanted) << "other light";
}

/// A copy of a cache that a run has filled, each file of it then changed.
template <typename Change>
std::function<void(const TemporaryFolder&)> filled_cache(Change change) {
  return [change](const TemporaryFolder& folder) {
    static const TemporaryFolder filled;
    static const Outcome once =
        run(driver_cache() +
            with_folder("CLPV_PROGRAM_CACHE= XDG_CACHE_HOME=@ " CLPV_PROGRAM " " + kFew + "-o @/first.npy",
                        filled));
    EXPECT_EQ(once.exit_code, 0) << once.err;
    fs::create_directories(folder / "cache");
    fs::copy(filled / "clpv", folder / "cache/clpv", fs::copy_options::recursive);
    std::size_t changed = 0;
    for (const auto& entry :
         std::vector<fs::directory_entry>(fs::directory_iterator(folder / "cache/clpv"), {})) {
      change(entry.path());
      ++changed;
    }
    EXPECT_GT(changed, 0u) << "nothing was kept";
  };
}

TEST(HostileSurroundings, CachesDoNotMatter) {
  const std::string cache = "CLPV_PROGRAM_CACHE= XDG_CACHE_HOME=@/cache";
  const auto write = [](const fs::path& file, const std::string& bytes) {
    std::ofstream(file, std::ios::binary) << bytes;
  };
  expect_the_same_light("no home at all", "env -u HOME -u XDG_CACHE_HOME CLPV_PROGRAM_CACHE=", {});
  expect_the_same_light("a file for a home", "CLPV_PROGRAM_CACHE= XDG_CACHE_HOME=@/file",
                        [](const TemporaryFolder& folder) { folder.write("file", ""); });
  expect_the_same_light("a home that is not there", "CLPV_PROGRAM_CACHE= XDG_CACHE_HOME= HOME=/proc/none",
                        {});
  expect_the_same_light("files of nothing", cache,
                        filled_cache([=](const fs::path& file) { write(file, ""); }));
  expect_the_same_light("files of rubbish", cache,
                        filled_cache([=](const fs::path& file) { write(file, std::string(5000, 'x')); }));
  expect_the_same_light("files cut in half", cache, filled_cache([=](const fs::path& file) {
                          fs::resize_file(file, fs::file_size(file) / 2);
                        }));
  expect_the_same_light("folders for files", cache, filled_cache([](const fs::path& file) {
                          fs::remove(file);
                          fs::create_directories(file / "below");
                        }));
  expect_the_same_light("links in circles for files", cache, filled_cache([](const fs::path& file) {
                          fs::remove(file);
                          fs::create_symlink(file.filename(), file);
                        }));
}

}  // namespace
}  // namespace clpv::test::hostile_surroundings_test
