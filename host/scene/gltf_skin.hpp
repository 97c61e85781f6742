// SPDX-License-Identifier: MIT
// The skins of a glTF document that its nodes wear.
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <vector>

#include "scene/gltf_document.hpp"
#include "scene/skin.hpp"

namespace clpv {

/// Reads each skin once, when it is first asked for.
class SkinReader {
 public:
  SkinReader(const GltfDocument& document, const NodeTree& tree);

  /// Throws Error(bad_input) for joints that are not among the tree's nodes, inverse bind matrices of another kind or fewer
  /// than joints, and more joints than the bounds allow.
  std::shared_ptr<const Skin> read(int index);

 private:
  const GltfDocument& document_;
  std::vector<std::optional<std::size_t>> in_tree_;  ///< of each node of the document
  std::map<int, std::shared_ptr<const Skin>> skins_;
  std::size_t joints_ = 0;
};

}  // namespace clpv
