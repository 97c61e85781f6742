// SPDX-License-Identifier: MIT
// The limit on a row's time: who ends in time is not met, who does not is named.
#include "bench/row_watch.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <future>

namespace clpv::bench::row_watch_test {
namespace {

using namespace std::chrono_literals;

TEST(RowWatch, LetsThroughWhatEndsInTime) {
  std::atomic<int> hung{0};
  RowWatch watch(10s, [&](const std::string&) { ++hung; });
  for (int i = 0; i < 1000; ++i) EXPECT_EQ(watch.watched("row", [&] { return i; }), i);
  EXPECT_THROW(watch.watched("row", []() -> int { throw 1; }), int);
  EXPECT_EQ(hung, 0);
}

TEST(RowWatch, NamesTheRowThatDoesNotEnd) {
  std::promise<std::string> named;
  RowWatch watch(50ms, [&](const std::string& row) { named.set_value(row); });
  watch.watched("slow", [&] {
    auto said = named.get_future();
    EXPECT_EQ(said.wait_for(30s), std::future_status::ready);
    EXPECT_EQ(said.get(), "slow");
  });
}

TEST(RowWatch, WithoutALimitThereIsNoThread) {
  RowWatch watch(0s, [](const std::string&) { FAIL(); });
  watch.watched("row", [] { std::this_thread::sleep_for(5ms); });
}

}  // namespace
}  // namespace clpv::bench::row_watch_test
