// SPDX-License-Identifier: MIT
// Random access to a glTF accessor: strided, normalised, sparse or all zeros. Nothing is copied, so that
// making one costs the same whatever its size.
#pragma once

#include <cstdint>
#include <initializer_list>
#include <optional>
#include <span>
#include <string>

#include "scene/gltf_document.hpp"

namespace clpv {

/// The numbers that an accessor may hold where it is used.
struct Numbers {
  const char* words;
  bool (*include)(int component_type, bool normalized);
};

inline constexpr Numbers kNumbers{"numbers", [](int, bool) { return true; }};
inline constexpr Numbers kFloats{"floats (componentType 5126)", [](int type, bool normalized) {
                                   return type == TINYGLTF_COMPONENT_TYPE_FLOAT && !normalized;
                                 }};
inline constexpr Numbers kShares{
    "floats (componentType 5126) or normalized integers",
    [](int type, bool normalized) { return type == TINYGLTF_COMPONENT_TYPE_FLOAT || normalized; }};
inline constexpr Numbers kJoints{"unsigned integers (componentType 5121 or 5123)",
                                 [](int type, bool normalized) {
                                   return !normalized && (type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE ||
                                                          type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT);
                                 }};
inline constexpr Numbers kIndices{"unsigned integers (componentType 5121, 5123 or 5125)",
                                  [](int type, bool normalized) {
                                    return kJoints.include(type, normalized) ||
                                           (type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT && !normalized);
                                  }};

class GltfAccessor {
 public:
  /// An accessor of the document, which must outlive it. Throws Error(bad_input) where it does not lie within its views.
  GltfAccessor(const GltfDocument& document, int index);

  /// The same where `place` (a JSON pointer) refers to it. Throws Error(bad_input) unless it has one of these types
  /// (TINYGLTF_TYPE_...), such numbers, and `count` elements.
  GltfAccessor(const GltfDocument& document, int index, std::string place, std::initializer_list<int> types,
               const Numbers& numbers, std::optional<std::size_t> count = std::nullopt);

  std::size_t count() const { return accessor_->count; }
  int components() const { return components_; }

  /// One component of an element (which must be in range): normalised integers in [0, 1] or [-1, 1].
  double number(std::size_t element, int component) const;
  /// The same, which must be finite. Throws Error(bad_input).
  double finite(std::size_t element, int component) const;
  /// An unsigned integer.
  std::uint32_t index(std::size_t element, int component = 0) const;

 private:
  std::span<const std::uint8_t> elements(int view, std::size_t offset, std::size_t count, std::size_t stride,
                                         std::size_t bytes) const;
  const std::uint8_t* address(std::size_t element, int component) const;
  std::uint32_t replaced(std::size_t i) const;
  friend void check_accessors(const GltfDocument& document);

  const GltfDocument* document_;
  const tinygltf::Accessor* accessor_;
  std::string place_;
  int components_ = 0;
  std::size_t component_bytes_ = 0, element_bytes_ = 0, stride_ = 0;
  std::span<const std::uint8_t> values_;                          ///< empty: zeros
  std::size_t sparse_count_ = 0;                                  ///< elements that are replaced
  std::span<const std::uint8_t> sparse_indices_, sparse_values_;  ///< which, ascending, and by what
};

/// Throws Error(bad_input) where an accessor does not lie within its views, or its sparse indices do not ascend or leave it.
void check_accessors(const GltfDocument& document);

}  // namespace clpv
