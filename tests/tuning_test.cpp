// SPDX-License-Identifier: MIT
// Tunings: kept, found again, ignored where they are damaged; and `clpv tune` with the program that uses them.
#include "pipeline/tuning.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "device/device.hpp"
#include "support/error.hpp"
#include "support/named_enum.hpp"
#include "tests/support/run_program.hpp"
#include "volume/volume_format.hpp"

namespace clpv::tuning_test {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

Device some_device() {
  Device device;
  device.platform = "Platform", device.name = "Device", device.driver = "1.0";
  return device;
}

const TuningSubject kSubject{"sh2", TransportKind::sampled, State::coefficients,
                             32,    Storage::float32,       Layout::soa};
const Tuning kTuning{{16, 2}, 8, Layout::soa};

TEST(Tuning, IsFoundAgainForItsOwnDeviceAndSubject) {
  const test::TemporaryFolder folder;
  const TuningCache cache(folder.path() / "not" / "yet");
  EXPECT_FALSE(cache.load(some_device(), kSubject));
  cache.store(some_device(), kSubject, kTuning);
  ASSERT_TRUE(cache.load(some_device(), kSubject));
  EXPECT_EQ(*cache.load(some_device(), kSubject), kTuning);
  Device other = some_device();
  other.driver = "1.1";
  EXPECT_FALSE(cache.load(other, kSubject));
  TuningSubject bigger = kSubject;
  bigger.grid = 64;
  EXPECT_FALSE(cache.load(some_device(), bigger));
}

TEST(Tuning, DamageIsIgnored) {
  const test::TemporaryFolder folder;
  const TuningCache cache(folder.path());
  cache.store(some_device(), kSubject, kTuning);
  const auto file = cache.file_of(some_device(), kSubject);
  const std::string whole = test::read_file(file);
  const auto with = [&](const std::string& from, const std::string& to) {
    std::string text = whole;
    text.replace(text.find(from), from.size(), to);
    return text;
  };
  for (const std::string& text :
       {std::string(), whole.substr(0, whole.size() / 2), with("\"lanes\": 8", "\"lanes\": 7"),
        with("\"lanes\": 8", "\"lanes\": \"x\""), with("16", "0"), with("\"soa\"", "\"sao\""),
        std::string("[1, 2]")}) {
    std::ofstream(file, std::ios::trunc) << text;
    EXPECT_FALSE(cache.load(some_device(), kSubject)) << text;
  }
  std::ofstream(file, std::ios::trunc) << whole;
  EXPECT_TRUE(cache.load(some_device(), kSubject));
}

/// A program with a cache of its own.
struct User {
  test::TemporaryFolder home;
  test::Outcome run(const std::string& arguments) const {
    return test::run("XDG_CACHE_HOME=" + home.path().string() + " " + CLPV_PROGRAM + " " + arguments);
  }
};

TEST(TuneProgram, RenderUsesWhatWasFoundUnlessToldNotTo) {
  const User user;
  const auto tuned =
      user.run("tune --basis sh2 --grid 8 --layout soa --occlusion off --repetitions 1 --json");
  ASSERT_EQ(tuned.exit_code, 0) << tuned.err;
  EXPECT_THAT(tuned.out, HasSubstr("\"chosen\": true"));
  const std::string render =
      std::string(" render ") + CLPV_SOURCE_DIR +
      "/scenes/cornell.json --basis sh2 --transport sampled --grid 8 --width 32 --height 24 -o " +
      (user.home.path() / "a.exr").string();
  const auto used = user.run("-v" + render);
  ASSERT_EQ(used.exit_code, 0) << used.err;
  EXPECT_THAT(used.err, HasSubstr("tuned: layout"));
  EXPECT_THAT(user.run("-v" + render + " --no-tune").err, Not(HasSubstr("tuned")));

  for (const auto& entry : std::filesystem::directory_iterator(user.home.path() / "clpv")) {
    if (entry.path().extension() == ".tuning") std::ofstream(entry.path(), std::ios::trunc) << "{";
  }
  const auto damaged = user.run(render);
  EXPECT_EQ(damaged.exit_code, 0) << damaged.err;
  EXPECT_THAT(damaged.err, HasSubstr("tuning ignored"));
}

TEST(TuneProgram, EveryLayoutIsTried) {
  const User user;
  const auto tuned =
      user.run("tune --basis sh2 --grid 1 --storage float --occlusion off --repetitions 1 --json");
  ASSERT_EQ(tuned.exit_code, 0) << tuned.err;
  for (const std::string& layout : names_of<Layout>()) {
    if (layout == "image" && !choose_device().images) continue;
    EXPECT_THAT(tuned.out, HasSubstr("\"layout\": \"" + layout + "\""));
  }
}

TEST(TuneProgram, RefusesBadUsage) {
  const User user;
  EXPECT_EQ(user.run("tune --basis sh17").exit_code, 2);
  EXPECT_EQ(user.run("tune --transport upwind --state fluxes").exit_code, 2);
  EXPECT_EQ(user.run("tune --transport sweep").exit_code, 2);
  EXPECT_EQ(user.run("tune --grid 0").exit_code, 2);
}

}  // namespace
}  // namespace clpv::tuning_test
