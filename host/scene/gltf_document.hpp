// SPDX-License-Identifier: MIT
// A glTF document read by tinygltf after checks of its JSON. Internal to the loader; includes
// tinygltf.
#pragma once

#include <tiny_gltf.h>

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <span>
#include <string>
#include <vector>

#include "scene/input.hpp"

namespace clpv {

/// Entry of one of tinygltf's lists, by an index in range.
template <typename T>
const T& entry(const std::vector<T>& list, int index) {
  return list[index];
}

struct GltfDocument {
  std::string file;              ///< path from the user, for messages
  std::filesystem::path folder;  ///< canonical path of the folder to which reads are restricted
  /// Indices are in range; images are not read.
  tinygltf::Model model;

  /// Bytes of a buffer view.
  std::span<const std::uint8_t> view(int index) const;
};

/// Reads a .gltf or .glb; the content determines which. Throws Error(bad_input).
GltfDocument read_gltf_document(const std::filesystem::path& path);

/// Checks parsed JSON before tinygltf reads it: types, ranges, indices, views within their buffers,
/// and all that tinygltf trusts. Throws Error(bad_input). Defined in gltf_schema.cpp, with
/// reads_extension().
void check_gltf(const nlohmann::json& document, const std::string& file);

/// Returns true if the loader reads that extension.
bool reads_extension(const std::string& name);

}  // namespace clpv
