// SPDX-License-Identifier: MIT
// 64-bit content hash used as a cache key. Not cryptographic.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

namespace clpv {

/// Incremental hash. Each add() includes the length, so that "ab","c" and "a","bc" differ.
class Fingerprint {
 public:
  Fingerprint& add(std::span<const std::byte> bytes);
  Fingerprint& add(std::string_view text) { return add(std::as_bytes(std::span(text))); }
  /// Adds the bytes of a vector or value. T has no padding.
  template <typename T>
  requires std::is_trivially_copyable_v<T> Fingerprint& add(const std::vector<T>& values) {
    return add(std::as_bytes(std::span(values)));
  }
  template <typename T>
  requires(std::is_trivially_copyable_v<T> &&
           !std::is_pointer_v<T>) Fingerprint& add(const T& value) {
    return add(std::as_bytes(std::span(&value, 1)));
  }

  std::uint64_t value() const { return state_; }
  std::string hex() const;  ///< value() as 16 hexadecimal digits

 private:
  std::uint64_t state_ = 0;
};

/// Returns the hash of the running program's executable file. Throws Error(run_time) if it cannot
/// be read.
std::string program_fingerprint();

}  // namespace clpv
