// SPDX-License-Identifier: MIT
// Text that is safe to print, fingerprints of content, and processes: output, exit codes, input.

#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <functional>
#include <regex>
#include <set>
#include <string>
#include <string_view>

#include "clpv/version.hpp"
#include "support/error.hpp"
#include "support/fingerprint.hpp"
#include "support/interrupt.hpp"
#include "support/process.hpp"
#include "support/text.hpp"
#include "tests/support/run_here.hpp"
#include "tests/support/run_program.hpp"

namespace clpv::support_test {

TEST(Version, HasAnEntryInTheCitationAndTheChanges) {
  const std::string source = CLPV_SOURCE_DIR;
  EXPECT_THAT(test::read_file(source + "/CITATION.cff"),
              ::testing::HasSubstr("\nversion: " + version() + "\n"));
  EXPECT_THAT(test::read_file(source + "/CHANGELOG.md"),
              ::testing::HasSubstr("\n## " + version() + " ("));
}

TEST(Printable, TextStaysAsItIs) {
  for (const std::string text :
       {"", "a b~", "two\nlines\tand a tab", "\u00e9\u20ac\U0001F4A1", "\u00a0"})
    EXPECT_EQ(printable(text), text);
}

TEST(TerminalJson, ControlCharactersAreEscaped) {
  EXPECT_EQ(terminal_json("{\"a\": \"\u00e9\u009b1\x7f\"}\n"),
            "{\"a\": \"\u00e9\\u009b1\\u007f\"}\n");
}

// A terminal that takes single bytes obeys 0x9b as it does U+009B.
TEST(Printable, OtherBytesAndControlCharactersBecomeQuestionMarks) {
  // Latin-1; overlong, surrogates, beyond U+10FFFF, no first bytes; cut off; controls; C1.
  for (const auto& [text, shown] : {
           std::pair<std::string, std::string>{"caf\xe9 \xfc", "caf? ?"},
           {"\xc0\x80 \xe0\x80\xaf \xed\xa0\x80 \xf4\x90\x80\x80", "?? ??? ??? ????"},
           {"\xff\x9b \xc0\x9b \xe0\x80\x9b \xf8", "?? ?? ??? ?"},
           {"\xf5\x80\x80\x80z", "????z"},
           {"\xc2", "?"},
           {"a\xe2\x82", "a??"},
           {"\xe2\x82z", "??z"},
           {"\x1b[31mred\x1b[0m\r\b\x7f", "?[31mred?[0m???"},
           {std::string("a\0b", 3), "a?b"},
           {"\u0080a\u009bb\u009f", "?a?b?"},
       })
    EXPECT_EQ(printable(text), shown);
}

TEST(Printable, ErrorsAndXmlAre) {
  const Error error(ExitCode::bad_input, "{}: no '{}'", "a.gltf", "\x1b[2J");
  EXPECT_STREQ(error.what(), "a.gltf: no '?[2J'");
  EXPECT_EQ(xml_escaped("<a\x01&\x1b\n>"), "&lt;a?&amp;?\n>");
}

TEST(InFileName, HasOnlyPlainCharactersAndTellsNamesApart) {
  std::set<std::string> parts;
  const std::string wide = "\xc3\xbc", longer(65, 'a');
  for (const std::string& name :
       {std::string("front"), std::string("Front-2_b"), std::string(64, 'a'), longer, longer + "b",
        std::string(), std::string("."), std::string(".."), std::string("_"), std::string("a b"),
        std::string("a_b"), std::string("a\0b", 3), std::string("a/b"), std::string("a\nb"), wide,
        std::string("x/../../../home/victim"), std::string("a.0001"), std::string("%d")}) {
    const std::string part = in_file_name(name);
    EXPECT_EQ(part, in_file_name(name));
    EXPECT_TRUE(std::regex_match(part, std::regex("[A-Za-z0-9_-]{1,73}"))) << part;
    EXPECT_TRUE(parts.insert(part).second) << part;
  }
  for (const std::string same : {"front", "Front-2_b", "_"}) EXPECT_EQ(in_file_name(same), same);
  EXPECT_EQ(in_file_name("a b").substr(0, 4), "a_b-");
  EXPECT_EQ(view_file_name("room", "left"), "room-left");
}

std::string of(const std::vector<std::string>& pieces) {
  Fingerprint print;
  for (const std::string& piece : pieces) print.add(piece);
  return print.hex();
}

TEST(Fingerprint, DependsOnTheBoundariesOfItsInputs) {
  EXPECT_EQ(of({"ab", "c"}), of({"ab", "c"}));
  const std::set<std::string> names = {of({}),          of({""}),        of({"", ""}),
                                       of({"abc"}),     of({"ab", "c"}), of({"a", "bc"}),
                                       of({"abc", ""}), of({"acb"})};
  EXPECT_EQ(names.size(), 8u);
  for (const std::string& name : names) EXPECT_EQ(name.size(), 16u);
}

using ::testing::HasSubstr;

TEST(Process, ReturnsOutputAndExitCode) {
  const Process::Result ended = Process("/bin/sh", {"-c", "echo out; echo err >&2; exit 7"}).end();
  EXPECT_EQ(ended.code, 7);
  EXPECT_EQ(ended.output, "out\nerr\n");
  EXPECT_EQ(Process("/bin/sh", {"-c", "kill -9 $$"}).end().code, 128 + 9);
}

TEST(Process, ReadsWhatItIsFed) {
  Process counter("/usr/bin/wc", {"-c"}, true);
  const std::string many(1 << 20, 'x');
  EXPECT_TRUE(counter.feed(std::as_bytes(std::span(many))));
  EXPECT_THAT(counter.end().output, HasSubstr("1048576"));
  EXPECT_EQ(Process("/bin/cat", {}).end().output, "")
      << "there is nothing to read, and no waiting for it";
}

TEST(Process, OneThatReadsNoMoreIsNoSignal) {
  Process gone("/bin/sh", {"-c", "exec 0<&-; echo enough; exit 3"}, true);
  const std::string many(1 << 22, 'x');
  EXPECT_FALSE(gone.feed(std::as_bytes(std::span(many))));
  const Process::Result ended = gone.end();
  EXPECT_EQ(ended.code, 3);
  EXPECT_EQ(ended.output, "enough\n");
}

TEST(Process, AnInterruptEndsIt) {
  const StopRequest stop = true;
  const StopScope scope(&stop);
  EXPECT_EQ(Process("/bin/sleep", {"60"}).end().code, 128 + SIGKILL);
  const test::TemporaryFolder folder;
  const std::string late = (folder / "late").string();
  Process script("/bin/sh", {"-c", "(sleep 0.5; echo >" + late + ") & wait"});
  ::usleep(100000);
  EXPECT_EQ(script.end().code, 128 + SIGKILL);
  ::usleep(600000);
  EXPECT_FALSE(std::filesystem::exists(late)) << "what it started";
}

TEST(Process, OneThatIsNotThere) {
  const Process::Result ended = Process("/nowhere/none", {}).end();
  EXPECT_EQ(ended.code, -1);
  EXPECT_THAT(ended.output, HasSubstr("No such file"));
  EXPECT_EQ(Process("a program of this name", {}).end().code, -1);
  EXPECT_EQ(Process("sh", {"-c", "exit 5"}).end().code, -1) << "not searched in the path";
}

/// Runs `act` in a fork, which may change its signals; its exit code, 128 + signal.
int in_fork(const std::function<int()>& act) {
  const pid_t child = ::fork();
  if (child == 0) ::_exit(act());
  int status = 0;
  ::waitpid(child, &status, 0);
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

TEST(Process, ChildrenHaveUsualSignals) {
  EXPECT_EQ(in_fork([] {
              sigset_t all;
              sigfillset(&all);
              ::sigprocmask(SIG_SETMASK, &all, nullptr);
              for (const int signal : {SIGXFSZ, SIGPIPE}) std::signal(signal, SIG_IGN);
              const char* status =  // bits 12 and 24
                  "grep -Eq '^SigBlk:\\s*0+$' /proc/self/status && "
                  "exit $((0x$(sed -n 's/^SigIgn:\\s*//p' /proc/self/status) & 0x1001000 ? 1 : 0))";
              return Process("/bin/sh", {"-c", status}).end().code;
            }),
            0);
}

// The child of a killed `clpv report` wrote its page later.
TEST(Process, ChildrenEndWithTheirParent) {
  const test::TemporaryFolder folder;
  const std::string late = (folder / "late").string();
  EXPECT_EQ(in_fork([&] {
              Process child("/bin/sh", {"-c", "sleep 0.3; echo >" + late});
              ::raise(SIGKILL);
              return 0;
            }),
            128 + SIGKILL);
  ::usleep(600000);
  EXPECT_FALSE(std::filesystem::exists(late));
}

// Numbers on the command line: one parser reads those of all options of all commands.

TEST(ParseNumber, IsDecimalAndFinite) {
  for (const auto& [text, value] : {std::pair("1", 1.0),
                                    {"+1", 1},
                                    {"010", 10},
                                    {"-2.5", -2.5},
                                    {".5", 0.5},
                                    {"1.", 1},
                                    {"1e-1", 0.1},
                                    {"+5E-1", 0.5}})
    EXPECT_EQ(parse_number<double>(text), value) << text;
  for (const char* text :
       {"",      " ",    "1 ",  " 1",  "1,5", "0x10", "inf", "-inf", "nan", "infinity",
        "1e999", "1.5x", "--1", "+-1", "-+1", "++1",  "1e",  "+",    "1_0", "\xd9\xa3"})
    EXPECT_FALSE(parse_number<double>(text)) << text;
  EXPECT_FALSE(parse_number<float>("1e99"));
  EXPECT_EQ(parse_number<int>("+016"), 16);
  for (const char* text : {"16.0", "1e1", "99999999999999999999", "0x10"})
    EXPECT_FALSE(parse_number<int>(text)) << text;
  EXPECT_FALSE(parse_number<unsigned>("-1"));
}

}  // namespace clpv::support_test
