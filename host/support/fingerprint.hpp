// SPDX-License-Identifier: MIT
// A short name for a lot of content: the key of what a cache keeps. Not cryptographic.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

namespace clpv {

/// Takes in content piece by piece. Each piece carries its length, so that "ab","c" and "a","bc" differ.
class Fingerprint {
 public:
  Fingerprint& add(std::span<const std::byte> bytes);
  Fingerprint& add(std::string_view text) { return add(std::as_bytes(std::span(text))); }
  /// By its bytes: T has no padding.
  template <typename T>
  requires std::is_trivially_copyable_v<T> Fingerprint& add(const std::vector<T>& values) {
    return add(std::as_bytes(std::span(values)));
  }
  /// The same.
  template <typename T>
  requires(std::is_trivially_copyable_v<T> && !std::is_pointer_v<T>) Fingerprint& add(const T& value) {
    return add(std::as_bytes(std::span(&value, 1)));
  }

  std::uint64_t value() const { return state_; }
  /// The same as 16 hexadecimal digits.
  std::string hex() const;

 private:
  std::uint64_t state_ = 0;
};

/// Of the running program's own file, so of everything compiled into it. Throws Error(run_time) where it cannot be read.
std::string program_fingerprint();

}  // namespace clpv
