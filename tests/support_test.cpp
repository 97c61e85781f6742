// SPDX-License-Identifier: MIT
// Text that is safe to print, and fingerprints of content.
#include <gtest/gtest.h>

#include <set>

#include "support/error.hpp"
#include "support/fingerprint.hpp"
#include "support/text.hpp"

namespace clpv::support_test {
namespace {

TEST(Printable, TextStaysAsItIs) {
  for (const std::string text :
       {"", "a b~", "two\nlines\tand a tab", "\u00e9\u20ac\U0001F4A1", "\u00a0", "\xc2", "\xff\x9b"})
    EXPECT_EQ(printable(text), text);
}

TEST(Printable, ControlCharactersBecomeMarks) {
  EXPECT_EQ(printable("\x1b[31mred\x1b[0m\r\b\x7f"), "?[31mred?[0m???");
  EXPECT_EQ(printable(std::string("a\0b", 3)), "a?b");
  EXPECT_EQ(printable("\u0080a\u009bb\u009f"), "?a?b?");  // C1, of two bytes each
}

TEST(Printable, ErrorsAndXmlAre) {
  const Error error(ExitCode::bad_input, "{}: no '{}'", "a.gltf", "\x1b[2J");
  EXPECT_STREQ(error.what(), "a.gltf: no '?[2J'");
  EXPECT_EQ(xml_escaped("<a\x01&\x1b\n>"), "&lt;a?&amp;?\n>");
}

std::string of(const std::vector<std::string>& pieces) {
  Fingerprint print;
  for (const std::string& piece : pieces) print.add(piece);
  return print.hex();
}

TEST(Fingerprint, TellsPiecesApart) {
  EXPECT_EQ(of({"ab", "c"}), of({"ab", "c"}));
  const std::set<std::string> names = {of({}),          of({""}),        of({"", ""}),    of({"abc"}),
                                       of({"ab", "c"}), of({"a", "bc"}), of({"abc", ""}), of({"acb"})};
  EXPECT_EQ(names.size(), 8u);
  for (const std::string& name : names) EXPECT_EQ(name.size(), 16u);
}

TEST(Fingerprint, SeesEveryBit) {
  std::vector<std::uint32_t> values(1000, 0);
  std::set<std::string> names = {Fingerprint().add(values).hex()};
  for (std::size_t i = 0; i < values.size(); ++i) {
    values[i] = 1u << (i % 32);
    names.insert(Fingerprint().add(values).hex());
    values[i] = 0;
  }
  EXPECT_EQ(names.size(), 1001u);
}

TEST(Fingerprint, OfTheProgramIsStable) {
  EXPECT_EQ(program_fingerprint(), program_fingerprint());
}

}  // namespace
}  // namespace clpv::support_test
