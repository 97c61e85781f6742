// SPDX-License-Identifier: MIT
// Materials: factors, alpha, and which textures they want with which texture coordinates; and those textures.
#pragma once

#include <glm/glm.hpp>
#include <vector>

#include "scene/gltf_document.hpp"
#include "scene/notes.hpp"
#include "scene/scene.hpp"

namespace clpv {

/// How a vertex's texture coordinates come about: set TEXCOORD_n, then uv' = transform (u, v, 1).
struct UvMapping {
  int set = 0;
  glm::dmat3 transform{1.0};
  friend bool operator==(const UvMapping&, const UvMapping&) = default;
};

/// One texture to be made: an image seen through a sampler.
struct TextureRequest {
  int image;
  std::uint32_t wrap_u, wrap_v;
  friend bool operator==(const TextureRequest&, const TextureRequest&) = default;
};

struct MaterialSet {
  std::vector<Material> materials;       ///< those of the document in its order, then glTF's default material
  std::vector<UvMapping> mappings;       ///< one a material
  std::vector<TextureRequest> textures;  ///< Material::texture indexes these
};

/// Throws Error(bad_input).
MaterialSet read_materials(const GltfDocument& document, Notes& notes);

/// Decodes each requested image (PNG or JPEG, told by its first bytes, not by name or mimeType) on all cores, where its header
/// keeps the bounds.
/// Row 0 is v = 0. Throws Error(bad_input) for the first bad one in the document's order.
std::vector<Texture> load_textures(const GltfDocument& document, const std::vector<TextureRequest>& requests);

}  // namespace clpv
