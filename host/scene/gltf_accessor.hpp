// SPDX-License-Identifier: MIT
// Random access to a glTF accessor: strided, normalised, sparse or all zeros. Nothing is copied, so that
// making one costs the same whatever its size.
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "scene/gltf_document.hpp"

namespace clpv {

class GltfAccessor {
 public:
  /// The document must outlive it.
  GltfAccessor(const GltfDocument& document, int index);

  std::size_t count() const { return accessor_->count; }
  int components() const { return components_; }
  int component_type() const { return accessor_->componentType; }
  bool normalized() const { return accessor_->normalized; }
  std::string place() const;  ///< its JSON pointer

  /// One component of an element (which must be in range): normalised integers in [0, 1] or [-1, 1].
  double number(std::size_t element, int component) const;
  /// An unsigned integer.
  std::uint32_t index(std::size_t element, int component = 0) const;

 private:
  const std::uint8_t* address(std::size_t element, int component) const;
  std::uint32_t sparse_index(std::size_t i) const;
  friend void check_sparse(const GltfDocument& document);

  const tinygltf::Accessor* accessor_;
  int index_;
  int components_ = 0;
  std::size_t component_bytes_ = 0, element_bytes_ = 0, stride_ = 0;
  std::span<const std::uint8_t> values_;  ///< empty: zeros
  std::size_t sparse_count_ = 0;
  std::span<const std::uint8_t> sparse_indices_;  ///< the elements replaced, ascending
  std::span<const std::uint8_t> sparse_values_;   ///< densely packed
};

/// Throws Error(bad_input) where the sparse indices of an accessor do not ascend or leave it.
void check_sparse(const GltfDocument& document);

}  // namespace clpv
