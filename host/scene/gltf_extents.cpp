// SPDX-License-Identifier: MIT
// Offsets, counts and strides are below 2^32 by schema, so that none of these products overflows 64 bits.
#include "scene/gltf_extents.hpp"

#include <nlohmann/json.hpp>

#include "scene/input.hpp"
#include "support/error.hpp"

namespace clpv {

using nlohmann::json;

namespace {

void check_views(const json& document, const std::string& file) {
  if (!document.contains("bufferViews")) return;
  for (std::size_t i = 0; i < document["bufferViews"].size(); ++i) {
    const json& view = document["bufferViews"][i];
    const std::string place = fmt::format("/bufferViews/{}", i);
    const std::uint64_t end =
        view.value("byteOffset", std::uint64_t{0}) + view["byteLength"].get<std::uint64_t>();
    const std::size_t buffer = view["buffer"];
    const std::uint64_t size = document["buffers"][buffer]["byteLength"];
    if (end > size) {
      refuse(file, place, fmt::format("bytes up to {}", end),
             fmt::format("at most the {} of /buffers/{}", size, buffer));
    }
    if (const std::uint64_t stride = view.value("byteStride", std::uint64_t{4}); stride % 4 != 0) {
      refuse(file, place + "/byteStride", fmt::format("{}", stride), "a multiple of 4 from 4 to 252");
    }
  }
}

std::uint64_t component_bytes(std::int64_t component_type) {
  return component_type <= 5121 ? 1 : component_type <= 5123 ? 2 : 4;
}

/// Bytes of one element; a matrix's columns start at multiples of 4 bytes.
std::uint64_t element_bytes(const std::string& type, std::uint64_t component) {
  if (type == "SCALAR") return component;
  const std::uint64_t n = static_cast<std::uint64_t>(type.back() - '0');
  if (type.starts_with("VEC")) return n * component;
  return n * ((n * component + 3) / 4 * 4);
}

/// `count` elements of `element` bytes, `stride` apart, from `offset` on, within a view.
void check_extent(const json& document, const json& reader, std::uint64_t count, std::uint64_t element,
                  bool strided, const std::string& file, const std::string& place) {
  const std::size_t index = reader["bufferView"];
  const json& view = document["bufferViews"][index];
  const std::uint64_t stride = strided ? view.value("byteStride", element) : element;
  if (stride < element) {
    refuse(file, place, fmt::format("elements of {} bytes", element),
           fmt::format("at most the byteStride {} of /bufferViews/{}", stride, index));
  }
  const std::uint64_t end = reader.value("byteOffset", std::uint64_t{0}) + (count - 1) * stride + element;
  const std::uint64_t size = view["byteLength"];
  if (end > size) {
    refuse(file, place, fmt::format("{} elements up to byte {}", count, end),
           fmt::format("at most the {} bytes of /bufferViews/{}", size, index));
  }
}

void check_accessors(const json& document, const std::string& file) {
  if (!document.contains("accessors")) return;
  for (std::size_t i = 0; i < document["accessors"].size(); ++i) {
    const json& accessor = document["accessors"][i];
    const std::string place = fmt::format("/accessors/{}", i);
    const std::uint64_t count = accessor["count"];
    const std::uint64_t element = element_bytes(accessor["type"], component_bytes(accessor["componentType"]));
    if (accessor.contains("bufferView")) check_extent(document, accessor, count, element, true, file, place);
    if (!accessor.contains("sparse")) continue;
    const json& sparse = accessor["sparse"];
    const std::uint64_t replaced = sparse["count"];
    if (replaced > count) {
      refuse(file, place + "/sparse/count", fmt::format("{}", replaced),
             fmt::format("1 to the accessor's {}", count));
    }
    check_extent(document, sparse["indices"], replaced, component_bytes(sparse["indices"]["componentType"]),
                 false, file, place + "/sparse/indices");
    check_extent(document, sparse["values"], replaced, element, false, file, place + "/sparse/values");
  }
}

/// tinygltf refuses indices without a view, and does not say where.
void check_indices(const json& document, const std::string& file) {
  if (!document.contains("meshes")) return;
  for (std::size_t m = 0; m < document["meshes"].size(); ++m) {
    const json& primitives = document["meshes"][m]["primitives"];
    for (std::size_t p = 0; p < primitives.size(); ++p) {
      if (!primitives[p].contains("indices")) continue;
      const std::size_t accessor = primitives[p]["indices"];
      if (!document["accessors"][accessor].contains("bufferView")) {
        refuse(file, fmt::format("/meshes/{}/primitives/{}/indices", m, p),
               fmt::format("/accessors/{} without a bufferView", accessor), "an accessor with a bufferView");
      }
    }
  }
}

}  // namespace

void check_gltf_extents(const json& document, const std::string& file) {
  check_views(document, file);
  check_accessors(document, file);
  check_indices(document, file);
}

}  // namespace clpv
