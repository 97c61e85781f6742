// SPDX-License-Identifier: MIT
// Counts of floating-point operations.
#pragma once

namespace clpv {

/// Floating-point operations of a kernel per cell.
struct OperationCount {
  int additions = 0;  ///< additions, subtractions, comparisons
  int multiplications = 0;
  int fused = 0;  ///< fma: two operations each
  int flops() const { return additions + multiplications + 2 * fused; }
};

}  // namespace clpv
