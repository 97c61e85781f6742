// SPDX-License-Identifier: MIT
// Numbers on the command line: one parser reads those of all options of all commands.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "cli/commands.hpp"
#include "support/error.hpp"
#include "support/text.hpp"
#include "tests/support/run_here.hpp"

namespace clpv::numbers_test {
namespace {

using ::testing::HasSubstr;

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

/// The error of an option with this value; empty if it accepts it.
std::string error_of_value(CLI::Option& option, const std::string& text) {
  option.clear();
  option.add_result(text);
  try {
    option.run_callback();
  } catch (const CLI::Error& error) {
    return error.what();
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ExitCode::usage);
    return error.what();
  }
  return {};
}

/// A number that the option takes; empty for options that take words, choices or vectors.
std::string number_for(CLI::Option& option) {
  for (const char* other : {"word", "3,0"})
    if (error_of_value(option, other).empty()) return {};
  for (const char* number : {"3", "0.3", "40"})
    if (error_of_value(option, number).empty()) return number;
  return {};
}

// A new option that CLI11 converts by itself fails here.
TEST(Numbers, OfAllOptionsAreReadAlike) {
  CLI::App app;
  Shared shared;
  add_commands(app, shared, all_commands());
  int numeric = 0;
  for (CLI::App* command : app.get_subcommands({})) {
    for (CLI::Option* option : command->get_options()) {
      if (option->get_items_expected_max() == 0) continue;  // a flag
      const std::string number = number_for(*option);
      if (number.empty()) continue;
      SCOPED_TRACE(command->get_name() + " " + option->get_name());
      ++numeric;
      for (const std::string& good : {"+" + number, "00" + number})
        EXPECT_EQ(error_of_value(*option, good), "");
      for (const std::string bad :
           {"nan", "inf", "-inf", "0x3", "1,5", "1e999", " 3", "3 ", "3x"}) {
        const std::string error = error_of_value(*option, bad);
        EXPECT_THAT(error, HasSubstr(option->get_name()));
        EXPECT_THAT(error, HasSubstr("found '" + bad + "', allowed: "));
        EXPECT_LT(error.size(), 150u) << error;
      }
    }
  }
  EXPECT_GT(numeric, 60);
}

TEST(Numbers, OfVectors) {
  const std::string before = "render none.json -o none.exr --target 0,0,0 ";
  for (const char* good : {"0,2,0.5", "'0, 2, 0.5'", "' 0,2,.5'", "+0,2e0,5e-1"})
    EXPECT_EQ(test::run_here(before + "--eye=" + good).exit_code, 3) << good << ": no such scene";
  for (const char* bad : {"'0 2 0.5'", "0,2", "0,2,0,5", "0;2;0.5", "0,2,inf", "0,nan,1", "0,2,0x1",
                          "0,,1", "0,2,0.5,", ",2,0.5", "0,2,1e999"}) {
    const test::Outcome outcome = test::run_here(before + "--eye=" + bad);
    EXPECT_EQ(outcome.exit_code, 2) << bad;
    EXPECT_THAT(outcome.err, HasSubstr("--eye"));
  }
  for (const char* bad : {"--sun=1,-1,0,5,10", "--sun=1,-1", "--sun=1,-1,0.5,inf", "--medium=nan",
                          "--medium=0.05,0.01,1", "--medium=inf", "--medium=0,05,0,01"})
    EXPECT_EQ(test::run_here(before + "--eye 0,0,1 " + bad).exit_code, 2) << bad;
}

}  // namespace
}  // namespace clpv::numbers_test
