// SPDX-License-Identifier: MIT
// A glTF document as tinygltf reads it, after our check of its JSON. Internal to the loader; includes tinygltf.
#pragma once

#include <tiny_gltf.h>

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <span>
#include <string>
#include <vector>

#include "scene/input.hpp"

namespace clpv {

/// An entry of one of tinygltf's lists, by an index that has been checked.
template <typename T>
const T& entry(const std::vector<T>& list, int index) {
  return list[index];
}

struct GltfDocument {
  std::string file;              ///< as the user named it, for messages
  std::filesystem::path folder;  ///< canonical; nothing outside it is read
  tinygltf::Model model;  ///< indices in range; an Image's `image` holds the encoded bytes of a data URI

  /// The bytes of a buffer view.
  std::span<const std::uint8_t> view(int index) const;
};

/// Reads a .gltf or .glb (told apart by content). Throws Error(bad_input).
GltfDocument read_gltf_document(const std::filesystem::path& path);

/// Checks parsed JSON before tinygltf reads it: types, ranges, indices within their lists, views within their buffers, and
/// whatever tinygltf trusts. Throws Error(bad_input). In gltf_schema.cpp, as is reads_extension.
void check_gltf(const nlohmann::json& document, const std::string& file);

/// Returns true if the loader reads that extension.
bool reads_extension(const std::string& name);

}  // namespace clpv
