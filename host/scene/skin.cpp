// SPDX-License-Identifier: MIT
#include "scene/skin.hpp"

namespace clpv {

std::span<const glm::dmat4> PosedTree::joints(const Skin& skin) {
  std::vector<glm::dmat4>& matrices = joints_[&skin];
  if (matrices.empty()) {
    for (std::size_t i = 0; i < skin.joints.size(); ++i)
      matrices.push_back(to_world_[skin.joints[i]] * skin.inverse_binds[i]);
  }
  return matrices;
}

}  // namespace clpv
