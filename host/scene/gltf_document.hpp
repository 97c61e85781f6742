// SPDX-License-Identifier: MIT
// A glTF model in memory: guarded, checked, and its buffers read. Internal to the loader; includes tinygltf.
#pragma once

#include <tiny_gltf.h>

#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "scene/input.hpp"

namespace clpv {

/// Where an image's encoded bytes are: a part of a buffer, a data URI, or a file of its own.
struct GltfImage {
  std::string uri;  ///< empty: in the buffer view
  std::optional<std::size_t> buffer_view;
};

struct GltfDocument {
  std::string file;              ///< as the user named it, for messages
  std::filesystem::path folder;  ///< canonical; nothing outside it is read
  tinygltf::Model model;         ///< all but buffers, images and animations, which tinygltf never sees
  std::vector<GltfImage> images;
  std::vector<Bytes> buffers;
  std::vector<std::string> ignored_extensions;       ///< used, not required, and not read
  std::shared_ptr<const nlohmann::json> animations;  ///< checked; null: none

  /// A checked view's bytes.
  std::span<const std::uint8_t> view(std::size_t index) const;
};

/// Reads a .gltf or .glb (told apart by content). Throws Error(bad_input).
GltfDocument read_gltf_document(const std::filesystem::path& path);

/// The bytes of a base64 data URI. Throws Error(bad_input).
Bytes decode_data_uri(const std::string& uri, const std::string& file, std::string_view place);

}  // namespace clpv
