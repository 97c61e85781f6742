// SPDX-License-Identifier: MIT
// In place of ray_scene.cpp and embree_tree.cpp in a build without Embree (CLPV_PATHTRACER=OFF).
#include "pathtracer/ray_scene.hpp"
#include "pipeline/gather/tree_builders.hpp"

namespace clpv {

BuiltNode* build_by_areas(const SceneData& scene, const std::vector<std::uint32_t>& triangles,
                          bool moves, const TreeLimits& limits, TreePool& pool) {
  return build_by_medians(scene, triangles, moves, limits, pool);
}

namespace pathtracer {

struct RayScene::Impl {
  reference::Materials materials;
};

void require_rays(ExitCode code) {
  throw Error(code, "this clpv was built without Embree (CLPV_PATHTRACER=OFF); it traces no rays");
}

RayScene::RayScene(const SceneData&) {
  require_rays(ExitCode::run_time);
}
RayScene::~RayScene() = default;
RayScene::RayScene(RayScene&&) noexcept = default;
RayScene& RayScene::operator=(RayScene&&) noexcept = default;

// No RayScene exists to call these.
const reference::Materials& RayScene::materials() const {
  return impl_->materials;
}
std::optional<Hit> RayScene::intersect(const glm::vec3&, const glm::vec3&, float, float,
                                       Faces) const {
  return std::nullopt;
}
bool RayScene::occluded(const glm::vec3&, const glm::vec3&, float) const {
  return false;
}
glm::vec3 RayScene::offset_origin(const Hit& hit) const {
  return hit.position;
}
glm::dvec3 RayScene::way_off_surfaces(const glm::dvec3&, const glm::dvec3&, double) const {
  return glm::dvec3(0);
}
reference::Footprint footprint(const ClpvView&, unsigned, unsigned, const Hit&) {
  return {};
}

}  // namespace pathtracer
}  // namespace clpv
