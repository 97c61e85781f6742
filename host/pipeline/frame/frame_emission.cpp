// SPDX-License-Identifier: MIT
#include "pipeline/frame/frame_emission.hpp"

#include <algorithm>

#include "support/fingerprint.hpp"
#include "support/log.hpp"

namespace clpv {
namespace {

/// Returns true if a triangle belongs to a moving part.
bool moves(const SceneData& scene, std::uint32_t triangle) {
  return std::ranges::any_of(scene.moving, [&](const MeshRange& part) {
    return triangle >= part.first_triangle && triangle - part.first_triangle < part.triangles;
  });
}

}  // namespace

FrameEmission::FrameEmission(Session& session, const SceneData& scene, const SceneBuffers& buffers)
    : session_(session),
      scene_(scene),
      buffers_(buffers),
      triangles_(emissive_triangles(scene)),
      emitter_(session, buffers) {
  moving_ = std::ranges::any_of(triangles_, [&](std::uint32_t t) { return moves(scene, t); });
}

double FrameEmission::max_flux(double cell) {
  measured_.update(Fingerprint().add(cell).add(instant()).value(),
                   [&] { max_flux_ = max_emitted_flux(scene_, triangles_, cell); });
  return max_flux_;
}

void FrameEmission::prepare(const std::vector<ClpvGrid>& grids, float scale, unsigned epoch) {
  Fingerprint wanted;
  for (const ClpvGrid& grid : grids) wanted.add(grid.origin).add(grid.cell);
  planned_.update(wanted.add(instant()).value(),
                  [&] { plan_ = plan_emission(scene_, triangles_, grids); });
  if (plan_.coarsened > coarsened_) {
    log_warning(
        "emissive surfaces: points {} times as far apart as usual, so that there are at most {}",
        1 << plan_.coarsened, kMaxEmittedPoints);
    coarsened_ = plan_.coarsened;
  }
  scale_ = scale;
  key_ = Fingerprint().add(plan_.parts).add(scale).add(instant()).add(epoch).value();
}

void FrameEmission::emit() {
  emitted_.update(key_, [&] {
    const StageScope scope(session_, {Pass::emit});
    emitter_.emit(plan_, scale_);
  });
}

}  // namespace clpv
