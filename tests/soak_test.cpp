// SPDX-License-Identifier: MIT
// Work that goes on: many frames of changing options in one process, whose memory must stay what it is; many processes at
// once on one cache, which must not disturb each other.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdlib>
#include <fstream>

#include "pipeline/frame.hpp"
#include "scene/load.hpp"
#include "tests/support/run_program.hpp"

namespace clpv::soak_test {
namespace {

namespace fs = std::filesystem;

const std::string kTiny = CLPV_SOURCE_DIR "/tests/oclgrind/tiny.gltf";

constexpr double kFlat = 1.01;  // over frames()

/// More by CLPV_SOAK_FRAMES (500 for docs/security.md).
int frames() {
  const char* wish = std::getenv("CLPV_SOAK_FRAMES");
  return wish != nullptr ? std::atoi(wish) : 20;
}

/// Memory of the process that is its own [bytes].
double resident_bytes() {
  std::ifstream in("/proc/self/statm");
  double total = 0, resident = 0;
  in >> total >> resident;
  return resident * static_cast<double>(::sysconf(_SC_PAGESIZE));
}

RenderOptions small(TransportKind transport, Layout layout, int grid) {
  RenderOptions options;
  options.basis = "sh2", options.transport = transport, options.layout = layout, options.grid = grid;
  options.width = 24, options.height = 18;
  options.cascades = 2, options.cascade_size = 5;
  options.rsm_size = 16, options.shadow_size = 16;
  options.directions = options.coarser_directions = Directions::of24;
  return options;
}

TEST(Soak, MemoryStaysFlatOverFramesOfChangingOptions) {
  const std::vector<RenderOptions> all = {
      small(TransportKind::sweep, Layout::soa, 8), small(TransportKind::sampled, Layout::soa, 12),
      small(TransportKind::sampled, Layout::aos, 8), small(TransportKind::sweep, Layout::soa, 16)};
  const Scene scene = load_scene(kTiny);
  Session session(choose_device());
  const auto render = [&](int i) {
    Frame frame(session, scene, all[static_cast<std::size_t>(i) % all.size()]);
    frame.render(scene.camera({}));
    frame.read(Show::full);
  };
  const auto render_some = [&] {
    for (int i = 0; i < frames(); ++i) render(i);
  };
  // What is built stays built, and allocators take a while to reach their level: what leaks never does.
  render_some();
  constexpr int kMostRounds = 6;
  std::vector<double> resident{resident_bytes()};
  const std::size_t device_before = session.device_bytes(), most_before = session.peak_device_bytes();
  do {
    render_some();
    resident.push_back(resident_bytes());
  } while (resident.back() > kFlat * resident.end()[-2] && resident.size() <= kMostRounds);
  EXPECT_LE(resident.back(), kFlat * resident.end()[-2]) << testing::PrintToString(resident);
  EXPECT_EQ(session.device_bytes(), device_before);
  EXPECT_EQ(session.peak_device_bytes(), most_before);
}

/// As many as CLPV_AT_ONCE says: each compiles what it needs where caches are empty.
int at_once() {
  const char* wish = std::getenv("CLPV_AT_ONCE");
  return wish != nullptr ? std::atoi(wish) : 2;
}

/// The same command so many times at once, each with its number for '#'; all must go well.
void all_at_once(const std::string& command) {
  std::string together;
  for (int i = 0; i < at_once(); ++i) {
    std::string one = command;
    for (std::size_t at = 0; (at = one.find('#', at)) != std::string::npos;)
      one.replace(at, 1, std::to_string(i));
    together += one + " & p" + std::to_string(i) + "=$!; ";
  }
  for (int i = 0; i < at_once(); ++i) together += "wait $p" + std::to_string(i) + " || exit; ";
  const test::Outcome outcome = test::run(together);
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
}

TEST(ManyAtOnce, ShareAnEmptyProgramCache) {
  const test::TemporaryFolder folder;
  const std::string at = folder.path().string();
  const std::string render =
      test::usual_kernels() + "CLPV_PROGRAM_CACHE= XDG_CACHE_HOME=" + at +
      "/cache " CLPV_PROGRAM " -v render " + kTiny +
      " --width 12 --height 9 --grid 5 --cascades 1 --cascade-size 5 --rsm-size 8 --shadow-size 8 --basis sh2"
      " --transport sampled --gather all --blockers seen -o " +
      at;
  all_at_once(render + "/#.exr");
  const std::string first = test::read_file(folder / "0.exr");
  EXPECT_FALSE(first.empty());
  for (int i = 1; i < at_once(); ++i)
    EXPECT_TRUE(test::read_file(folder / (std::to_string(i) + ".exr")) == first) << i;
  for (const auto& entry : fs::directory_iterator(folder / "cache/clpv"))
    EXPECT_EQ(entry.path().extension(), ".program") << "left behind";
  const test::Outcome next = test::run(render + "/next.exr");
  EXPECT_EQ(next.exit_code, 0) << next.err;
  EXPECT_THAT(next.err, testing::HasSubstr("from the cache"));
  EXPECT_TRUE(test::read_file(folder / "next.exr") == first);
}

TEST(ManyAtOnce, ShareAnEmptyQualityCache) {
  const test::TemporaryFolder folder;
  const std::string at = folder.path().string();
  all_at_once(
      CLPV_PROGRAM " quality " + kTiny +
      " --width 12 --height 9 --grid 5 --cascades 1 --cascade-size 5 --rsm-size 8 --shadow-size 8 --basis sh2"
      " --transport sampled --spp 4 --frames 1 --cache " +
      at + "/kept --json " + at + "/#.json");
  for (const auto& entry : fs::recursive_directory_iterator(folder / "kept"))
    EXPECT_FALSE(entry.path().filename().string().starts_with(".")) << entry.path();
  const test::Outcome again = test::run(
      CLPV_PROGRAM " --quiet quality " + kTiny +
      " --width 12 --height 9 --grid 5 --cascades 1 --cascade-size 5 --rsm-size 8 --shadow-size 8 --basis sh2"
      " --transport sampled --spp 4 --frames 1 --cache " +
      at + "/kept --format json");
  EXPECT_EQ(again.exit_code, 0) << again.err;
  EXPECT_EQ(again.err, "");
}

}  // namespace
}  // namespace clpv::soak_test
