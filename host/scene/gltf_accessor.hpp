// SPDX-License-Identifier: MIT
// Random access to a glTF accessor: strided, normalised, sparse or all zeros, without a copy of its
// data.
#pragma once

#include <cstdint>
#include <initializer_list>
#include <optional>
#include <span>
#include <string>

#include "scene/gltf_document.hpp"
#include "scene/primitive.hpp"

namespace clpv {

/// Set of component types that an accessor may have for one purpose.
struct ComponentTypes {
  const char* description;
  bool (*include)(int component_type, bool normalized);
};

inline constexpr ComponentTypes kNumbers{"numbers", [](int, bool) { return true; }};
inline constexpr ComponentTypes kFloats{
    "floats (componentType 5126)",
    [](int type, bool normalized) { return type == TINYGLTF_COMPONENT_TYPE_FLOAT && !normalized; }};
inline constexpr ComponentTypes kFractions{
    "floats (componentType 5126) or normalized integers",
    [](int type, bool normalized) { return type == TINYGLTF_COMPONENT_TYPE_FLOAT || normalized; }};
inline constexpr ComponentTypes kJoints{
    "unsigned integers (componentType 5121 or 5123)", [](int type, bool normalized) {
      return !normalized && (type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE ||
                             type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT);
    }};
inline constexpr ComponentTypes kIndices{
    "unsigned integers (componentType 5121, 5123 or 5125)", [](int type, bool normalized) {
      return kJoints.include(type, normalized) ||
             (type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT && !normalized);
    }};

class GltfAccessor : public NumberArray {
 public:
  /// Borrows the document. Throws Error(bad_input) if the accessor exceeds its views.
  GltfAccessor(const GltfDocument& document, int index);

  /// The accessor that the JSON pointer `place` refers to. Throws Error(bad_input) unless it has
  /// one of `types` (TINYGLTF_TYPE_...), a component type of `numbers`, and `count` elements.
  GltfAccessor(const GltfDocument& document, int index, std::string place,
               std::initializer_list<int> types, const ComponentTypes& numbers,
               std::optional<std::size_t> count = std::nullopt);

  std::size_t count() const override { return accessor_->count; }
  int components() const override { return components_; }

  /// Normalised integers become [0, 1] or [-1, 1].
  double number(std::size_t element, int component) const override;
  std::uint32_t index(std::size_t element, int component = 0) const override;
  [[noreturn]] void reject_element(std::size_t element, const std::string& found,
                                   const std::string& allowed) const override;

 private:
  std::span<const std::uint8_t> elements(int view, std::size_t offset, std::size_t count,
                                         std::size_t stride, std::size_t bytes) const;
  const std::uint8_t* address(std::size_t element, int component) const;
  std::uint32_t sparse_index(std::size_t i) const;
  friend void check_accessors(const GltfDocument& document);

  const GltfDocument* document_;
  const tinygltf::Accessor* accessor_;
  std::string place_;
  int components_ = 0;
  std::size_t component_bytes_ = 0, element_bytes_ = 0, stride_ = 0;
  std::span<const std::uint8_t> values_;  ///< empty: all values are 0
  std::size_t sparse_count_ = 0;          ///< number of replaced elements
  /// Replaced elements, ascending, and their values.
  std::span<const std::uint8_t> sparse_indices_, sparse_values_;
};

/// Throws Error(bad_input) for accessors beyond their views, and sparse indices that do not ascend
/// or are out of range.
void check_accessors(const GltfDocument& document);

}  // namespace clpv
