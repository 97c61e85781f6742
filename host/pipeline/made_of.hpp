// SPDX-License-Identifier: MIT
// What a product on the device was made of, so that it is made anew when that changed and at no other time.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <type_traits>
#include <utility>
#include <vector>

namespace clpv {

/// What a product is made of: values, and other products by what they are made of in turn. Two are equal when the same
/// was added in the same order, byte for byte. Options and a scene's materials are in none: they stay with a frame.
class MadeOf {
 public:
  /// By its bytes: T has no padding.
  template <typename T>
  requires std::is_trivially_copyable_v<T> MadeOf& add(const T& value) {
    return add_piece(std::as_bytes(std::span(&value, 1)));
  }
  template <typename T>
  requires std::is_trivially_copyable_v<T> MadeOf& add(const std::vector<T>& values) {
    return add_piece(std::as_bytes(std::span(values)));
  }
  MadeOf& add(const MadeOf& product) { return add_piece(product.bytes_); }

  bool operator==(const MadeOf&) const = default;

 private:
  /// Each piece carries its length, so that no two lists of pieces read alike.
  MadeOf& add_piece(std::span<const std::byte> piece) {
    const std::size_t size = piece.size();
    const auto prefix = std::as_bytes(std::span(&size, 1));
    bytes_.insert(bytes_.end(), prefix.begin(), prefix.end());
    bytes_.insert(bytes_.end(), piece.begin(), piece.end());
    return *this;
  }

  std::vector<std::byte> bytes_;
};

/// The record of one product, whose memory holds what was made last: one of several things in turn, where it is shared.
class Kept {
 public:
  /// Calls `make`, which makes the product of `wanted`, unless it is made of just that. One whose making throws is made of
  /// nothing.
  template <typename Make>
  void update(MadeOf wanted, const Make& make) {
    if (made_of_ == wanted) return;
    made_of_.reset();
    make();
    made_of_ = std::move(wanted);
  }

  void forget() { made_of_.reset(); }

 private:
  std::optional<MadeOf> made_of_;  ///< none: of nothing yet
};

}  // namespace clpv
