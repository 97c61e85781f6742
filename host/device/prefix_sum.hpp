// SPDX-License-Identifier: MIT
// Prefix sums of numbers on the device (kernels/prefix_sum.cl).
#pragma once

#include <cstddef>

#include "device/kernel.hpp"
#include "device/session.hpp"

namespace clpv {

/// Exclusive prefix sum of uints, in place.
class PrefixSum {
 public:
  explicit PrefixSum(Session& session);

  /// Replaces the first `count` values, at least one, by the sums of those before them. Value
  /// `count`, which the buffer has as well, and `total` (uint) become the sum of all.
  void run(const Buffer& values, std::size_t count, const Buffer& total);

 private:
  Session& session_;
  Kernel sum_blocks_, place_blocks_;
  Buffer totals_;
};

}  // namespace clpv
