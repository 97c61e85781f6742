#include "scene/gltf_accessor.hpp"

#include <algorithm>
#include <bit>
#include <cstring>

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
  const auto indices = document.view(static_cast<std::size_t>(sparse.indices.bufferView))
                           .subspan(static_cast<std::size_t>(sparse.indices.byteOffset));
  const auto bytes = static_cast<std::size_t>(
      tinygltf::GetComponentSizeInBytes(static_cast<std::uint32_t>(sparse.indices.componentType)));
  for (std::size_t i = 0; i < static_cast<std::size_t>(sparse.count); ++i) {
    const std::uint32_t element = load_unsigned(&indices[i * bytes], sparse.indices.componentType);
    if (element >= accessor_->count || (i > 0 && element <= sparse_.back())) {
      refuse(document.file, place() + "/sparse/indices", fmt::format("index {} at {}", element, i),
             fmt::format("ascending indices below {}", accessor_->count));
    }
    sparse_.push_back(element);
  }
  sparse_values_ = document.view(static_cast<std::size_t>(sparse.values.bufferView))
                       .subspan(static_cast<std::size_t>(sparse.values.byteOffset));
}

std::string GltfAccessor::place() const {
  return fmt::format("/accessors/{}", index_);
}

const std::uint8_t* GltfAccessor::address(std::size_t element, int component) const {
  const std::size_t within = component_bytes_ * static_cast<std::size_t>(component);
  if (!sparse_.empty()) {
    const auto found = std::lower_bound(sparse_.begin(), sparse_.end(), element);
    if (found != sparse_.end() && *found == element) {
      return &sparse_values_[static_cast<std::size_t>(found - sparse_.begin()) * element_bytes_ + within];
    }
  }
  return values_.empty() ? nullptr : &values_[element * stride_ + within];
}

double GltfAccessor::number(std::size_t element, int component) const {
  const std::uint8_t* from = address(element, component);
  return from == nullptr ? 0.0 : load_number(from, accessor_->componentType, accessor_->normalized);
}

std::uint32_t GltfAccessor::index(std::size_t element) const {
  const std::uint8_t* from = address(element, 0);
  return from == nullptr ? 0 : load_unsigned(from, accessor_->componentType);
}

}  // namespace clpv
