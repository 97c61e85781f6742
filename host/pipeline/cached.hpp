// SPDX-License-Identifier: MIT
// Cached results: recomputed when the key of their inputs changes, and at no other time.
#pragma once

#include <cstdint>
#include <optional>

namespace clpv {

/// Identifies the inputs of a result: a Fingerprint of versions and values. Options and a scene's materials are in none, as
/// they stay with a frame.
using CacheKey = std::uint64_t;

/// The key of a result whose memory holds what was computed last.
class Cached {
 public:
  /// Calls `compute` unless the result is that of `key`. A `compute` that throws leaves no result.
  template <typename Compute>
  void update(CacheKey key, const Compute& compute) {
    if (key_ == key) return;
    key_.reset();
    compute();
    key_ = key;
  }

 private:
  std::optional<CacheKey> key_;
};

}  // namespace clpv
