// SPDX-License-Identifier: MIT
// Cached results: recomputed only when the key of their inputs changes.
#pragma once

#include <cstdint>
#include <optional>

namespace clpv {

/// Identifies the inputs of a result: a Fingerprint of versions and values. It omits options and
/// materials, which are constant for a frame.
using CacheKey = std::uint64_t;

/// Key of a result whose memory stores the last computed value.
class Cached {
 public:
  /// Calls `compute` unless the result has key `key`. If `compute` throws, no result is cached.
  template <typename Compute>
  void update(CacheKey key, const Compute& compute) {
    if (key_ == key) return;
    key_.reset();
    compute();
    key_ = key;
  }

  void invalidate() { key_.reset(); }

 private:
  std::optional<CacheKey> key_;
};

}  // namespace clpv
