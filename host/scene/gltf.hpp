// SPDX-License-Identifier: MIT
// A glTF 2.0 model into a Scene.
#pragma once

#include <filesystem>

#include "scene/notes.hpp"
#include "scene/scene.hpp"

namespace clpv {

/// Loads a .gltf or .glb: geometry, materials, textures, cameras, lights, all in metres; no defaults are
/// added. Throws Error(bad_input).
Scene load_gltf(const std::filesystem::path& path, double metres_per_unit, Notes& notes);

}  // namespace clpv
