// SPDX-License-Identifier: MIT
// A glTF 2.0 model into a Scene.
#pragma once

#include <filesystem>

#include "scene/motion.hpp"
#include "scene/notes.hpp"
#include "scene/scene.hpp"

namespace clpv {

/// Loads a .gltf or .glb as it is at 0 s: geometry, materials, textures, cameras, lights, all in metres; no defaults are
/// added. `motion` becomes what of it moves. Throws Error(bad_input).
Scene load_gltf(const std::filesystem::path& path, double metres_per_unit, Motion& motion, Notes& notes);

}  // namespace clpv
