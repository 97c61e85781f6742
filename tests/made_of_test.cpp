// SPDX-License-Identifier: MIT
// Records of what products are made of.
#include "pipeline/made_of.hpp"

#include <gtest/gtest.h>

#include <stdexcept>

namespace clpv::made_of_test {
namespace {

TEST(MadeOf, IsEqualWhereTheSameWasAdded) {
  EXPECT_EQ(MadeOf().add(1).add(2.5f), MadeOf().add(1).add(2.5f));
  EXPECT_NE(MadeOf().add(1).add(2), MadeOf().add(2).add(1)) << "in the same order";
  EXPECT_NE(MadeOf().add(1), MadeOf().add(1).add(1));
  EXPECT_NE(MadeOf(), MadeOf().add(std::vector<int>()));
  EXPECT_NE(MadeOf().add(std::vector{1, 2}).add(std::vector{3}),
            MadeOf().add(std::vector{1}).add(std::vector{2, 3}));
  EXPECT_NE(MadeOf().add(0.0f), MadeOf().add(-0.0f)) << "by bytes";
}

TEST(MadeOf, HoldsWhatItsPartsAreMadeOf) {
  const MadeOf part = MadeOf().add(1).add(2);
  EXPECT_EQ(MadeOf().add(part).add(3), MadeOf().add(MadeOf().add(1).add(2)).add(3));
  EXPECT_NE(MadeOf().add(part).add(3), MadeOf().add(MadeOf().add(1).add(4)).add(3));
  EXPECT_NE(MadeOf().add(part).add(3), MadeOf().add(1).add(MadeOf().add(2).add(3)));
}

TEST(Kept, IsMadeWhereSomethingElseIsWanted) {
  Kept kept;
  int made = 0;
  const auto make = [&] { ++made; };
  kept.update(MadeOf(), make);
  EXPECT_EQ(made, 1) << "of nothing yet, which is not the same as of an empty list";
  kept.update(MadeOf(), make);
  EXPECT_EQ(made, 1);
  kept.update(MadeOf().add(7), make);
  kept.update(MadeOf().add(7), make);
  EXPECT_EQ(made, 2);
  kept.update(MadeOf(), make);
  EXPECT_EQ(made, 3) << "it holds what was made last";
  kept.forget();
  kept.update(MadeOf(), make);
  EXPECT_EQ(made, 4);
}

TEST(Kept, WhoseMakingFailsIsOfNothing) {
  Kept kept;
  kept.update(MadeOf().add(1), [] {});
  EXPECT_THROW(kept.update(MadeOf().add(2), [] { throw std::runtime_error("no memory"); }),
               std::runtime_error);
  int made = 0;
  kept.update(MadeOf().add(2), [&] { ++made; });
  kept.update(MadeOf().add(1), [&] { ++made; });
  EXPECT_EQ(made, 2);
}

}  // namespace
}  // namespace clpv::made_of_test
