// SPDX-License-Identifier: MIT
// Ranks as threads: every item belongs to one rank, sums do not depend on the order of ranks, and
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
  Ranks ranks;
  EXPECT_TRUE(ranks.alone() && ranks.is_root());
  EXPECT_GE(ranks.processors(), 1);
  EXPECT_TRUE(ranks.takes(0) && ranks.takes(7));
  double value = 2.5;
  ranks.sum({&value, 1});
  EXPECT_EQ(value, 2.5);
  EXPECT_THAT(ranks.gather("mine"), ElementsAre("mine"));
  EXPECT_EQ(ranks.from_root([] { return "made"; }), "made");
}

TEST(TeamTest, EachItemBelongsToOneRank) {
  for (const int size : {2, 3, 7}) {
    std::vector<std::atomic<int>> counts(100);
    test::run_ranks(size, [&](Ranks& ranks) {
      for (std::size_t i = 0; i < counts.size(); ++i) counts[i] += ranks.takes(i);
    });
    for (const auto& count : counts) EXPECT_EQ(count, 1) << size << " ranks";
  }
}

TEST(TeamTest, WhatOneRankMakesAllHave) {
  test::run_ranks(4, [](Ranks& ranks) {
    EXPECT_EQ(ranks.name(), "rank " + std::to_string(ranks.rank()) + " on threads");
    EXPECT_EQ(ranks.from_root([&] { return "of rank " + std::to_string(ranks.rank()); }), "of rank 0");
    double values[] = {ranks.rank() == 2 ? 0.1 : 0.0, 1.0};
    ranks.sum(values);
    EXPECT_EQ(values[0], 0.1) << "others add nothing to it";
    EXPECT_EQ(values[1], 4);
    const std::vector<std::string> all =
        ranks.gather(std::string(static_cast<std::size_t>(ranks.rank()), 'x'));
    if (ranks.is_root()) {
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
      test::run_ranks(size, [&](Ranks& ranks) {
        const test::TracedImage shared =
            reference::trace_paths(scene, scene.lights, view, options, {}, ranks);
        EXPECT_EQ(shared.irradiance, plain.irradiance) << size << " ranks";
        EXPECT_EQ(shared.rays, plain.rays);
        EXPECT_EQ(shared.samples, plain.samples);
      });
    }
  }
}

}  // namespace
}  // namespace clpv::ranks_test
