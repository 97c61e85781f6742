// SPDX-License-Identifier: MIT
// Tables for kernels as text, and the order of bins and links that kernels of the sweep rely on.
#include <gtest/gtest.h>

#include "basis/matrix.hpp"
#include "basis/sweep.hpp"
#include "kernels/shared/sweep.h"
#include "support/literals.hpp"

namespace clpv::test::constants_test {
namespace {

TEST(Constants, RoundingErrorsOfZerosAreZeroAndNotCounted) {
  Matrix matrix(2, 2);
  matrix(0, 0) = 0.5;
  matrix(0, 1) = -1e-14;
  matrix(1, 1) = -0.5;
  EXPECT_EQ(Literals().matrix("CLPV_M", matrix).defined().at("CLPV_M"),
            "{{0.5f, 0.0f}, \\\n  {0.0f, (-0.5f)}}");
  EXPECT_EQ(products(matrix), 2);
}

TEST(Constants, BinsAndLinksAreGroupedByAxis) {
  const std::vector<SweepBin> bins = sweep_bins(1);
  ASSERT_EQ(bins.size(), CLPV_SWEEP_BINS);
  for (std::size_t b = 0; b < bins.size(); ++b)
    EXPECT_EQ(bins[b].axis, static_cast<int>(b) / CLPV_AXIS_BINS) << "bin " << b;
  // Bits of a bin's index among those of its axis are signs (kernels/sweep/mirrored_bins.h).
  for (int b = 0; b < CLPV_SWEEP_BINS; ++b) {
    const int first = b - b % CLPV_AXIS_BINS;
    for (int bit = 0; bit < 3; ++bit) {
      const int axis = (bins[b].axis + 1 + bit) % 3;
      const bool same = bins[b].sign[axis] == bins[first].sign[axis];
      EXPECT_EQ(same, ((b - first) >> bit & 1) == 0) << "bin " << b << ", bit " << bit;
    }
  }
  const LinkVolumes links = link_volumes();
  EXPECT_EQ(links.across[1].size(), links.across[0].size());
  EXPECT_EQ(links.across[2].size(), links.across[0].size());
}

}  // namespace
}  // namespace clpv::test::constants_test
