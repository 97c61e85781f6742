// SPDX-License-Identifier: MIT
// Fingerprints: equal content, equal name; any change, another.
#include "support/fingerprint.hpp"

#include <gtest/gtest.h>

#include <set>

namespace clpv::fingerprint_test {
namespace {

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
}  // namespace clpv::fingerprint_test
