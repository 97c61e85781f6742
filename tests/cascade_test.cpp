// Cascades: nested round the camera, on whole cells.
#include "pipeline/cascade.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace clpv {
namespace {

TEST(Cascade, EachIsTwiceTheOneBeforeAndHoldsIt) {
  const auto grids = cascade_grids({1.3f, -2.7f, 40.1f}, 4, 12.5, 32);
  ASSERT_EQ(grids.size(), 4u);
  for (std::size_t c = 0; c + 1 < grids.size(); ++c) {
    EXPECT_FLOAT_EQ(grids[c + 1].cell, 2 * grids[c].cell);
    for (int axis = 0; axis < 3; ++axis) {
      EXPECT_LE(grids[c + 1].origin[axis], grids[c].origin[axis]);
      EXPECT_GE(grids[c + 1].origin[axis] + 32 * grids[c + 1].cell,
                grids[c].origin[axis] + 32 * grids[c].cell);
    }
  }
}

TEST(Cascade, OriginsAreWholeCellsAndTheEyeIsInTheMiddle) {
  for (const int cells : {1, 17, 32, 33}) {
    for (const ClpvGrid& grid : cascade_grids({-3.21f, 0.4f, 7.7f}, 3, 10.0, cells)) {
      const float eye[] = {-3.21f, 0.4f, 7.7f};
      for (int axis = 0; axis < 3; ++axis) {
        const double steps = grid.origin[axis] / grid.cell;
        EXPECT_NEAR(steps, std::round(steps), 1e-4);
        const double middle = grid.origin[axis] + 0.5 * cells * grid.cell;
        EXPECT_LE(std::abs(eye[axis] - middle), grid.cell * 1.001);
      }
    }
  }
}

TEST(Cascade, MovesByWholeCellsOnly) {
  const auto at = [](float x) { return cascade_grids({x, 0, 0}, 1, 32.0, 32)[0].origin[0]; };
  EXPECT_EQ(at(0.1f), at(0.9f));
  EXPECT_EQ(at(1.1f), at(0.9f) + 1);
  EXPECT_EQ(at(-0.1f), at(0.1f) - 1);
}

}  // namespace
}  // namespace clpv
