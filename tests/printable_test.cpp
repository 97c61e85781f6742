// SPDX-License-Identifier: MIT
// Nothing that a stranger wrote moves a terminal's cursor: what is printed has no control characters.
#include <gtest/gtest.h>

#include "support/error.hpp"
#include "support/text.hpp"

namespace clpv::printable_test {
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

}  // namespace
}  // namespace clpv::printable_test
