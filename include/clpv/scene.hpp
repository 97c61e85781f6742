// SPDX-License-Identifier: MIT
// Handle of a loaded scene.
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

namespace clpv {

/// Scene loaded from a scene file (.json) or a glTF model (.gltf, .glb). Copies share the data.
class SceneFile {
 public:
  /// `model` replaces the model of the scene file; empty: no replacement. Files are untrusted: sizes are checked before
  /// allocation, and only files in the folders of model and scene file are read. Throws Error(bad_input) with file, place, value found and value
  /// allowed.
  explicit SceneFile(const std::filesystem::path& path, const std::filesystem::path& model = {});

  std::vector<std::string> cameras() const;  ///< names of the cameras, at least one
  bool moves() const;                        ///< returns true if anything in it is animated
  std::vector<std::string> notes() const;    ///< one sentence for each thing skipped or added by the loader

  struct Contents;
  const Contents& contents() const { return *contents_; }

 private:
  std::shared_ptr<const Contents> contents_;
};

}  // namespace clpv
