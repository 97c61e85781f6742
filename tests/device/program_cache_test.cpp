// SPDX-License-Identifier: MIT
// Cache of compiled programs on disk: returns stored programs unchanged, and rejects any other
// content.

#include "device/program_cache.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <cstdlib>
#include <fstream>

#include "device/kernel.hpp"
#include "device/program.hpp"
#include "device/session.hpp"
#include "tests/support/error_of.hpp"
#include "tests/support/run_program.hpp"

namespace clpv::program_cache_test {

namespace fs = std::filesystem;
using Binary = ProgramCache::Binary;

void write_file(const fs::path& path, const std::string& bytes) {
  std::ofstream(path, std::ios::binary) << bytes;
}

struct ProgramCacheTest : ::testing::Test {
  test::TemporaryFolder folder_;
  ProgramCache cache_{folder_.path() / "made" / "on demand"};
};

TEST_F(ProgramCacheTest, ReturnsStoredPrograms) {
  EXPECT_FALSE(cache_.load("key").has_value());
  const Binary binary = {0, 1, 255, '\n', 0};
  EXPECT_TRUE(cache_.store("key", binary));
  EXPECT_EQ(cache_.load("key"), binary);
  EXPECT_TRUE(cache_.store("key", {7}));
  EXPECT_EQ(cache_.load("key"), Binary{7});
  EXPECT_EQ(std::distance(fs::directory_iterator(cache_.folder()), {}), 1) << "nothing beside";
  cache_.remove("key");
  EXPECT_FALSE(cache_.load("key").has_value());
}

TEST_F(ProgramCacheTest, KeyDependsOnEveryInput) {
  Device device;
  device.platform = "p", device.name = "n", device.driver = "d", device.version = "v";
  const std::string key = ProgramCache::key(device, "options", "text");
  EXPECT_NE(ProgramCache::key(device, "options2", "text"), key);
  EXPECT_NE(ProgramCache::key(device, "options", "text2"), key);
  for (auto field : {&Device::platform, &Device::platform_version, &Device::name, &Device::driver,
                     &Device::version}) {
    Device other = device;
    other.*field += "2";
    EXPECT_NE(ProgramCache::key(other, "options", "text"), key);
  }
}

TEST_F(ProgramCacheTest, SameFileNameOfAnotherKeyIsNotTaken) {
  cache_.store("one", {1});
  fs::rename(cache_.file_of("one"), cache_.file_of("two"));  // as if both had one hash
  EXPECT_FALSE(cache_.load("two").has_value());
}

TEST_F(ProgramCacheTest, DropsTheLeastRecentlyUsed) {
  const ProgramCache cache(folder_.path(), 2500);
  const Binary binary(1000, 1);
  const auto now = fs::file_time_type::clock::now();
  for (const char* key : {"a", "b"}) cache.store(key, binary);
  fs::last_write_time(cache.file_of("a"), now - std::chrono::hours(2));
  fs::last_write_time(cache.file_of("b"), now - std::chrono::hours(1));
  EXPECT_TRUE(cache.load("a").has_value());  // used: "b" is the oldest now
  // Any name with ".program" in it was once removed.
  const std::string hash(16, 'a');
  const fs::path part = folder_ / ("." + hash + ".program.7-0.part");
  write_file(part, std::string(1000, 'x'));
  fs::last_write_time(part, now - std::chrono::hours(3));
  const std::vector<fs::path> others{folder_ / "my.program.backup.tar", folder_ / "my.program",
                                     folder_ / (hash + ".program.old")};
  for (const fs::path& other : others) {
    write_file(other, "of the user");
    fs::last_write_time(other, now - std::chrono::hours(4));
  }
  cache.store("c", binary);
  EXPECT_FALSE(fs::exists(part)) << "of a killed process";
  for (const fs::path& other : others) EXPECT_TRUE(fs::exists(other)) << other;
  EXPECT_TRUE(cache.load("a").has_value());
  EXPECT_FALSE(cache.load("b").has_value());
  EXPECT_TRUE(cache.load("c").has_value());
}

TEST_F(ProgramCacheTest, UsersFolderIsTheDocumentedOne) {
  Device device = choose_device();  // PoCL takes its cache's folder from the environment now
  const fs::path home = folder_.path() / "home", cache = folder_.path() / "cache";
  const test::Variable homes("HOME", home.string()), caches("XDG_CACHE_HOME", cache.string()),
      setting("CLPV_PROGRAM_CACHE", std::nullopt);
  device.platform = "of a driver without a cache";
  EXPECT_EQ(ProgramCache::of_user(device)->folder(), cache / "clpv");
  caches.set("");
  EXPECT_EQ(ProgramCache::of_user(device)->folder(), home / ".cache/clpv");
  setting.set("off");
  EXPECT_FALSE(ProgramCache::of_user(device).has_value());
  setting.set(std::nullopt), homes.set(std::nullopt);
  EXPECT_FALSE(ProgramCache::of_user(device).has_value());
}

TEST_F(ProgramCacheTest, DriversThatKeepKernelsNeedNone) {
  Device device = choose_device();
  const test::Variable caches("XDG_CACHE_HOME", (folder_ / "cache").string()),
      setting("CLPV_PROGRAM_CACHE", std::nullopt);
  device.platform = "Portable Computing Language";
  EXPECT_FALSE(ProgramCache::of_user(device).has_value());
  setting.set("on");
  EXPECT_TRUE(ProgramCache::of_user(device).has_value());
}

/// A session's program from the cache; its kernel writes another value than a compiled one.
struct CachedSession : ProgramCacheTest {
  CachedSession() {
    write_file(folder_.path() / "answer.cl",
               "__kernel void answer(__global int* a) { if (get_global_id(0) == 0) a[0] = "
               "CLPV_ANSWER; }\n");
  }
  const test::Variable kernels_{"CLPV_KERNEL_DIR", folder_.path().string()};

  static ProgramSource source(int value) {
    const int lanes = choose_device().lanes;  // as a session adds them
    return {"answer.cl", Literals().integer("CLPV_ANSWER", value).integer("CLPV_W", lanes)};
  }
  std::string key(int value) const {
    return ProgramCache::key(choose_device(), source(value).options, program_text(source(value)));
  }
  /// The number that the kernel of source(value) writes; its program is stored afterwards.
  int answer(int value) const {
    Session session(choose_device(), cache_);
    const Buffer out = session.buffer(sizeof(int), "answer");
    Kernel(session, source(value), "answer").set(out).launch(1, 1);
    const int read = session.read<int>(out, 1)[0];
    session.programs().store();
    return read;
  }
};

TEST_F(CachedSession, TakesTheStoredProgram) {
  EXPECT_EQ(answer(1), 1);
  EXPECT_EQ(answer(2), 2);
  const auto two = cache_.load(key(2));
  ASSERT_TRUE(two.has_value()) << "Programs::store() kept it";
  cache_.store(key(1), *two);
  EXPECT_EQ(answer(1), 2) << "the cache was not asked";
}

TEST_F(CachedSession, RebuildsWhatIsRejected) {
  EXPECT_EQ(answer(3), 3);
  const Binary rejected(100, 42);
  cache_.store(key(3), rejected);
  EXPECT_EQ(answer(3), 3);
  EXPECT_NE(cache_.load(key(3)), rejected);
}

// Kernel text: embedded files, includes, the folder that overrides them, and build errors.

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

}  // namespace clpv::program_cache_test
