// SPDX-License-Identifier: MIT
// Teams of threads, which share work as teams of ranks do: every item belongs to one rank, sums do not depend on who adds, and
// path tracing gives the same bytes on any number of ranks.
#include "parallel/ranks.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <mutex>

#include "tests/support/thread_ranks.hpp"
#include "tests/support/traced_scenes.hpp"

namespace clpv::ranks_test {
namespace {

using ::testing::ElementsAre;

TEST(TeamTest, OneProcessIsATeamToo) {
  Ranks team;
  EXPECT_TRUE(team.alone() && team.is_root());
  EXPECT_GE(team.processors(), 1);
  EXPECT_TRUE(team.takes(0) && team.takes(7));
  double value = 2.5;
  team.sum({&value, 1});
  EXPECT_EQ(value, 2.5);
  EXPECT_THAT(team.gather("mine"), ElementsAre("mine"));
  EXPECT_EQ(team.from_root([] { return "made"; }), "made");
}

TEST(TeamTest, EachItemBelongsToOneRank) {
  for (const int size : {2, 3, 7}) {
    std::vector<std::atomic<int>> counts(100);
    test::as_team(size, [&](Ranks& team) {
      for (std::size_t i = 0; i < counts.size(); ++i) counts[i] += team.takes(i);
    });
    for (const auto& count : counts) EXPECT_EQ(count, 1) << size << " ranks";
  }
}

TEST(TeamTest, WhatOneRankMakesAllHave) {
  test::as_team(4, [](Ranks& team) {
    EXPECT_EQ(team.name(), "rank " + std::to_string(team.rank()) + " on threads");
    EXPECT_EQ(team.from_root([&] { return "of rank " + std::to_string(team.rank()); }), "of rank 0");
    double values[] = {team.rank() == 2 ? 0.1 : 0.0, 1.0};
    team.sum(values);
    EXPECT_EQ(values[0], 0.1) << "others add nothing to it";
    EXPECT_EQ(values[1], 4);
    const std::vector<std::string> all = team.gather(std::string(static_cast<std::size_t>(team.rank()), 'x'));
    if (team.is_root()) {
      EXPECT_THAT(all, ElementsAre("", "x", "xx", "xxx"));
    }
  });
}

TEST(TeamTest, PathsOfAnyNumberOfRanksAreTheSame) {
  Scene scene = test::floor_scene(0.5f);
  test::add_quad(scene, {-2, 0, -3}, {4, 0, 0}, {0, 4, 0}, 0);
  scene.lights = {test::sun({0.3f, -1, -0.2f}, 3)};
  const ClpvView view = test::view_of({0, 2, 3}, {0, -0.6f, -1}, {0, 1, 0}, 0.7f, 37, 21);
  for (const auto& [samples, noise] : {std::pair{7u, 0.0}, {0u, 0.05}}) {
    test::PathTracerOptions options;
    options.samples = samples, options.threads = 2;
    if (noise > 0) options.noise = noise;
    const test::TracedImage plain = test::trace_paths(scene, view, options);
    for (const int size : {2, 3}) {
      test::as_team(size, [&](Ranks& team) {
        const test::TracedImage shared = reference::trace_paths(scene, scene.lights, view, options, {}, team);
        EXPECT_EQ(shared.irradiance, plain.irradiance) << size << " ranks";
        EXPECT_EQ(shared.rays, plain.rays);
        EXPECT_EQ(shared.samples, plain.samples);
      });
    }
  }
}

}  // namespace
}  // namespace clpv::ranks_test
