// SPDX-License-Identifier: MIT
// Scene files and glTF models into a Scene.
#pragma once

#include <filesystem>

#include "scene/scene.hpp"

namespace clpv {

struct LoadOptions {
  std::filesystem::path model;  ///< replaces the scene file's model; empty: as the file says
};

/// Loads a scene file (.json: see docs/scenes.md), or a bare .gltf / .glb.
/// Untrusted input: everything is bounded before it is allocated, nothing outside the model's folder is read.
/// Throws Error(bad_input) that names file, place (JSON pointer), value found and value allowed.
Scene load_scene(const std::filesystem::path& path, const LoadOptions& options = {});

/// Whether the scene is a model without a scene file, which says nothing of cascades.
bool is_bare_model(const Scene& scene);

}  // namespace clpv
