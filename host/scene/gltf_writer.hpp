// SPDX-License-Identifier: MIT
// Writes a scene as a binary glTF file.
#pragma once

#include <filesystem>

#include "scene/scene.hpp"

namespace clpv {

/// Writes meshes, materials, textures, cameras and lights to a .glb. Logs a warning for a sky, a
/// medium and cameras with an only light, which glTF has not. Throws Error: usage (another
/// extension), run_time (the file cannot be written, or would be larger than 4 GiB).
void write_glb(const std::filesystem::path& path, const SceneData& scene);

}  // namespace clpv
