// SPDX-License-Identifier: MIT
// Teams of threads, which keep to what teams of ranks do: every item is done once, a failure stops one rank and is known to
// all, sums do not depend on who adds. And the order in which work is handed out.
#include "parallel/team.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <mutex>
#include <numeric>
#include <stdexcept>

#include "parallel/schedule.hpp"
#include "tests/support/thread_messages.hpp"

namespace clpv::team_test {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

/// What a rank found of a team, by rank.
template <typename T>
class ByRank {
 public:
  void set(const Team& team, T value) {
    const std::lock_guard lock(mutex_);
    if (values_.size() < static_cast<std::size_t>(team.size()))
      values_.resize(static_cast<std::size_t>(team.size()));
    values_[static_cast<std::size_t>(team.rank())] = std::move(value);
  }
  const std::vector<T>& values() const { return values_; }

 private:
  std::mutex mutex_;
  std::vector<T> values_;
};

TEST(TeamTest, AloneIsATeamToo) {
  Team team;
  EXPECT_TRUE(team.alone() && team.leads());
  EXPECT_GE(team.processors(), 1);
  std::vector<std::size_t> done;
  team.share({3, [&](std::size_t item) { done.push_back(item); }, [] { return "here"; }});
  EXPECT_THAT(done, ElementsAre(0, 1, 2));
  double value = 2.5;
  team.sum({&value, 1});
  EXPECT_EQ(value, 2.5);
  EXPECT_THAT(team.gather("mine"), ElementsAre("mine"));
  EXPECT_EQ(team.from_first([] { return "made"; }), "made");
  EXPECT_THROW(team.agree([] { throw std::out_of_range("as it was"); }), std::out_of_range);
  EXPECT_THROW(team.share({1, [](std::size_t) { throw std::out_of_range("as it was"); }, {}}),
               std::out_of_range);
}

TEST(TeamTest, EveryItemIsDoneOnceJobAfterJob) {
  for (const int size : {2, 3, 7}) {
    std::vector<std::atomic<int>> counts(100);
    test::as_team(size, [&](Team& team) {
      for (const std::size_t items : {100, 1, 0, 37}) {
        team.share({items,
                    [&](std::size_t item) {
                      ++counts[item];
                      team.done(1);
                    },
                    [] { return ""; }});
        EXPECT_EQ(team.done(0), items);
        team.barrier();
      }
    });
    for (std::size_t i = 0; i < counts.size(); ++i)
      EXPECT_EQ(counts[i], 1 + (i < 1) + (i < 37)) << i << " of " << size << " ranks";
  }
}

TEST(TeamTest, ARankThatFailsIsKnownToAllAndTheOthersGoOn) {
  std::vector<std::atomic<int>> counts(50);
  ByRank<std::string> thrown;
  test::as_team(3, [&](Team& team) {
    try {
      team.share({counts.size(),
                  [&](std::size_t item) {
                    if (team.rank() == 1) throw Error(ExitCode::device, "the device is gone");
                    while (team.done(0) == 0) std::this_thread::yield();  // rank 1 is to get its item
                    ++counts[item];
                  },
                  [&] {
                    team.done(1);
                    return "somewhere";
                  }});
    } catch (const TeamFailure& failure) {
      EXPECT_EQ(failure.code(), ExitCode::device);
      thrown.set(team, failure.what());
    }
  });
  EXPECT_THAT(thrown.values(), ::testing::Each(HasSubstr("1 of 3 ranks failed")));
  EXPECT_EQ(thrown.values().size(), 3u);
  EXPECT_EQ(std::ranges::count_if(counts, [](const auto& count) { return count == 0; }), 1)
      << "its item, and no other";
}

TEST(TeamTest, OneVoiceIsToldOnceOthersByTheirNames) {
  ByRank<std::string> alike, apart, some;
  const auto words_of = [](Team& team, const std::function<void()>& work) -> std::string {
    try {
      team.agree(work);
    } catch (const TeamFailure& failure) {
      EXPECT_EQ(failure.code(), ExitCode::bad_input);
      return failure.what();
    }
    return "nothing";
  };
  test::as_team(3, [&](Team& team) {
    alike.set(team, words_of(team, [] { throw Error(ExitCode::bad_input, "no such scene"); }));
    apart.set(team, words_of(team, [&] {
                throw Error(ExitCode::bad_input, "{} of them", team.rank() == 2 ? "one" : "two");
              }));
    some.set(team, words_of(team, [&] {
               if (team.rank() == 1) throw Error(ExitCode::bad_input, "no such scene");
             }));
    EXPECT_EQ(words_of(team, [] {}), "nothing");
  });
  for (const std::string& words : alike.values()) EXPECT_EQ(words, "no such scene");
  for (const std::string& words : apart.values())
    EXPECT_THAT(words, AllOf(HasSubstr("rank 2 on threads: one of them"),
                             HasSubstr("rank 0 on threads and 1 more: two of them")));
  for (const std::string& words : some.values()) EXPECT_EQ(words, "rank 1 on threads: no such scene");
}

TEST(TeamTest, WhatTheFirstMakesAllHave) {
  test::as_team(4, [](Team& team) {
    EXPECT_EQ(team.from_first([&] { return "of rank " + std::to_string(team.rank()); }), "of rank 0");
    double values[] = {team.rank() == 2 ? 0.1 : 0.0, 1.0};
    team.sum(values);
    EXPECT_EQ(values[0], 0.1) << "others add nothing to it";
    EXPECT_EQ(values[1], 4);
    const std::vector<std::string> all = team.gather(std::string(static_cast<std::size_t>(team.rank()), 'x'));
    if (team.leads()) {
      EXPECT_THAT(all, ElementsAre("", "x", "xx", "xxx"));
    }
  });
}

TEST(ScheduleTest, LongestFirstAndGroupsWholeWhereTheySuffice) {
  const std::vector<double> costs = {1, 1, 5, 5, 3, 3};
  const std::vector<std::vector<std::size_t>> groups = {{0, 1}, {}, {2, 3}, {4, 5}};
  EXPECT_THAT(longest_first(groups, costs, 3),
              ElementsAre(ElementsAre(2, 3), ElementsAre(4, 5), ElementsAre(0, 1)));
  EXPECT_THAT(longest_first(groups, costs, 4), ElementsAre(ElementsAre(2), ElementsAre(3), ElementsAre(4),
                                                           ElementsAre(5), ElementsAre(0), ElementsAre(1)));
  EXPECT_TRUE(longest_first({{}, {}}, {}, 2).empty());
}

TEST(ScheduleTest, RunsOfNeighboursGetShorter) {
  std::vector<std::size_t> items(100);
  std::iota(items.begin(), items.end(), 7);
  EXPECT_THAT(shrinking_runs(items, 1), ElementsAre(items));
  EXPECT_TRUE(shrinking_runs({}, 3).empty());
  const std::vector<Piece> runs = shrinking_runs(items, 3);
  std::vector<std::size_t> all;
  for (std::size_t i = 0; i < runs.size(); ++i) {
    EXPECT_LE(runs[i].size(), i == 0 ? 17 : runs[i - 1].size());
    all.insert(all.end(), runs[i].begin(), runs[i].end());
  }
  EXPECT_EQ(all, items);
  EXPECT_EQ(runs.back().size(), 1u);
}

}  // namespace
}  // namespace clpv::team_test
