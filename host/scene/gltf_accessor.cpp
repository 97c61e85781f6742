// SPDX-License-Identifier: MIT
#include "scene/gltf_accessor.hpp"

#include <algorithm>
#include <bit>
#include <cstring>

#include "scene/bounds.hpp"
#include "support/error.hpp"

namespace clpv {

static_assert(std::endian::native == std::endian::little, "glTF buffers are little endian and read in place");

namespace {

template <typename T>
T load(const std::uint8_t* from) {
  T value;
  std::memcpy(&value, from, sizeof value);
  return value;
}

std::uint32_t load_unsigned(const std::uint8_t* from, int component_type) {
  switch (component_type) {
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
      return *from;
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
      return load<std::uint16_t>(from);
    default:
      return load<std::uint32_t>(from);
  }
}

template <typename T>
double load_integer(const std::uint8_t* from, bool normalized) {
  const double value = load<T>(from);
  return normalized ? std::max(value / static_cast<double>(std::numeric_limits<T>::max()), -1.0) : value;
}

double load_number(const std::uint8_t* from, int component_type, bool normalized) {
  switch (component_type) {
    case TINYGLTF_COMPONENT_TYPE_BYTE:
      return load_integer<std::int8_t>(from, normalized);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
      return load_integer<std::uint8_t>(from, normalized);
    case TINYGLTF_COMPONENT_TYPE_SHORT:
      return load_integer<std::int16_t>(from, normalized);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
      return load_integer<std::uint16_t>(from, normalized);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
      return load_integer<std::uint32_t>(from, normalized);
    default:
      return load<float>(from);
  }
}

}  // namespace

GltfAccessor::GltfAccessor(const GltfDocument& document, int index)
    : accessor_(&document.model.accessors[static_cast<std::size_t>(index)]), index_(index) {
  components_ = tinygltf::GetNumComponentsInType(static_cast<std::uint32_t>(accessor_->type));
  component_bytes_ = static_cast<std::size_t>(
      tinygltf::GetComponentSizeInBytes(static_cast<std::uint32_t>(accessor_->componentType)));
  element_bytes_ = component_bytes_ * static_cast<std::size_t>(components_);
  if (accessor_->bufferView >= 0) {
    const auto view = static_cast<std::size_t>(accessor_->bufferView);
    values_ = document.view(view).subspan(accessor_->byteOffset);
    stride_ = document.model.bufferViews[view].byteStride;
    if (stride_ == 0) stride_ = element_bytes_;
  }
  if (!accessor_->sparse.isSparse) return;
  const auto& sparse = accessor_->sparse;
  sparse_count_ = static_cast<std::size_t>(sparse.count);
  const auto view = [&](int index, int offset) {
    return document.view(static_cast<std::size_t>(index)).subspan(static_cast<std::size_t>(offset));
  };
  sparse_indices_ = view(sparse.indices.bufferView, sparse.indices.byteOffset);
  sparse_values_ = view(sparse.values.bufferView, sparse.values.byteOffset);
}

std::string GltfAccessor::place() const {
  return fmt::format("/accessors/{}", index_);
}

const std::uint8_t* GltfAccessor::address(std::size_t element, int component) const {
  const std::size_t within = component_bytes_ * static_cast<std::size_t>(component);
  std::size_t first = 0, end = sparse_count_;
  while (first < end) {  // the first replaced element not before this one
    const std::size_t middle = first + (end - first) / 2;
    if (sparse_index(middle) < element) {
      first = middle + 1;
    } else {
      end = middle;
    }
  }
  if (first < sparse_count_ && sparse_index(first) == element) {
    return &sparse_values_[first * element_bytes_ + within];
  }
  return values_.empty() ? nullptr : &values_[element * stride_ + within];
}

std::uint32_t GltfAccessor::sparse_index(std::size_t i) const {
  const int type = accessor_->sparse.indices.componentType;
  const auto bytes =
      static_cast<std::size_t>(tinygltf::GetComponentSizeInBytes(static_cast<std::uint32_t>(type)));
  return load_unsigned(&sparse_indices_[i * bytes], type);
}

double GltfAccessor::number(std::size_t element, int component) const {
  const std::uint8_t* from = address(element, component);
  return from == nullptr ? 0.0 : load_number(from, accessor_->componentType, accessor_->normalized);
}

std::uint32_t GltfAccessor::index(std::size_t element, int component) const {
  const std::uint8_t* from = address(element, component);
  return from == nullptr ? 0 : load_unsigned(from, accessor_->componentType);
}

void check_sparse(const GltfDocument& document) {
  std::uint64_t total = 0;
  for (std::size_t a = 0; a < document.model.accessors.size(); ++a) {
    const GltfAccessor accessor(document, static_cast<int>(a));
    const std::string place = accessor.place() + "/sparse/indices";
    total += accessor.sparse_count_;
    if (total > bounds::kSparseElements) {
      refuse(document.file, place, fmt::format("{} sparse elements so far", total),
             fmt::format("at most {} in all", bounds::kSparseElements));
    }
    for (std::size_t i = 0; i < accessor.sparse_count_; ++i) {
      const std::uint32_t element = accessor.sparse_index(i);
      if (element >= accessor.count() || (i > 0 && element <= accessor.sparse_index(i - 1))) {
        refuse(document.file, place, fmt::format("index {} at {}", element, i),
               fmt::format("ascending indices below {}", accessor.count()));
      }
    }
  }
}

}  // namespace clpv
