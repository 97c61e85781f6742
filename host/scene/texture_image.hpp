// SPDX-License-Identifier: MIT
// Images of a model as 8-bit RGBA textures. Content decides the format, headers are bounded before decoding.
#pragma once

#include <vector>

#include "scene/gltf_document.hpp"
#include "scene/gltf_material.hpp"
#include "scene/scene.hpp"

namespace clpv {

/// Decodes each requested image (PNG or JPEG, told by its first bytes, not by name or mimeType) on all cores.
/// Row 0 is v = 0. Throws Error(bad_input) for the first bad one in the document's order.
std::vector<Texture> load_textures(const GltfDocument& document, const std::vector<TextureRequest>& requests);

}  // namespace clpv
