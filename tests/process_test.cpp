// SPDX-License-Identifier: MIT
// Programs run beside the tests: what they say, how they end, what they read.
#include "support/process.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string_view>

namespace clpv::process_test {
namespace {

using ::testing::HasSubstr;

TEST(Process, TellsWhatWasSaidAndHowItEnded) {
  const Process::Result ended = Process("/bin/sh", {"-c", "echo out; echo err >&2; exit 7"}).end();
  EXPECT_EQ(ended.code, 7);
  EXPECT_EQ(ended.output, "out\nerr\n");
  EXPECT_EQ(Process("/bin/sh", {"-c", "kill -9 $$"}).end().code, 128 + 9);
}

TEST(Process, ArgumentsGoThroughNoShell) {
  EXPECT_EQ(Process("/bin/echo", {"$HOME; 'a'  b"}).end().output, "$HOME; 'a'  b\n");
}

TEST(Process, ReadsWhatItIsFed) {
  Process counter("/usr/bin/wc", {"-c"}, true);
  const std::string many(1 << 20, 'x');
  EXPECT_TRUE(counter.feed(std::as_bytes(std::span(many))));
  EXPECT_THAT(counter.end().output, HasSubstr("1048576"));
  EXPECT_EQ(Process("/bin/cat", {}).end().output, "") << "there is nothing to read, and no waiting for it";
}

TEST(Process, OneThatReadsNoMoreIsNoSignal) {
  Process gone("/bin/sh", {"-c", "exec 0<&-; echo enough; exit 3"}, true);
  const std::string many(1 << 22, 'x');
  EXPECT_FALSE(gone.feed(std::as_bytes(std::span(many))));
  const Process::Result ended = gone.end();
  EXPECT_EQ(ended.code, 3);
  EXPECT_EQ(ended.output, "enough\n");
}

TEST(Process, OneThatIsNotThere) {
  const Process::Result ended = Process("/nowhere/none", {}).end();
  EXPECT_EQ(ended.code, -1);
  EXPECT_THAT(ended.output, HasSubstr("No such file"));
  EXPECT_EQ(Process("a program of this name", {}).end().code, -1);
  EXPECT_EQ(Process("sh", {"-c", "exit 5"}).end().code, 5) << "found in the path";
}

}  // namespace
}  // namespace clpv::process_test
