// SPDX-License-Identifier: MIT
// A scene as a user of the library holds it.
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

namespace clpv {

/// A scene read from a scene file (.json) or a bare glTF model (.gltf, .glb); cheap to copy.
class SceneFile {
 public:
  /// `model` replaces the scene file's; empty: as the file says. Input is untrusted: everything is bounded before it is
  /// allocated, and nothing outside the model's folder is read. Throws Error(bad_input) that names file, place, value
  /// found and value allowed.
  explicit SceneFile(const std::filesystem::path& path, const std::filesystem::path& model = {});

  std::vector<std::string> cameras() const;  ///< names; at least one
  bool moves() const;                        ///< whether it differs from instant to instant
  std::vector<std::string> notes() const;    ///< what was left out or added while reading, a sentence each

  struct Contents;
  const Contents& contents() const { return *contents_; }

 private:
  std::shared_ptr<const Contents> contents_;
};

}  // namespace clpv
