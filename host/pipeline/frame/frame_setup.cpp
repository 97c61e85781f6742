// SPDX-License-Identifier: MIT
#include "pipeline/frame/frame_setup.hpp"

#include <algorithm>

#include "basis/sweep.hpp"
#include "options/render_options.hpp"
#include "options/scene_options.hpp"
#include "support/error.hpp"

namespace clpv {
namespace {

/// A sky is far brighter than the interior behind walls, so leaks along diagonal links are most
/// visible with a sky.
constexpr double kClosedUnderASky = 0.75;
/// Bytes of the RSMs or of the volumes of all cascades: about the second cache of a GPU.
constexpr std::size_t kAtOnce = std::size_t{64} << 20;
constexpr std::size_t kRsmTexel = 36;  // depth, normal and flux as floats

}  // namespace

FrameSetup::FrameSetup(const RenderOptions& resolved, const SceneData& scene) : options(resolved) {
  validate(options, scene);
  basis = make_basis(options);
  options.basis = basis->name();
  gathered = sweeps() ? swept_basis() : basis;
  transport = make_transport(options, *basis);
  if (scene.sky && sweeps())
    close_diagonals(std::get<std::vector<SweepLink>>(transport.scheme), kClosedUnderASky);
}

FrameSetup::FrameSetup(const OptionValues& given, const SceneData& scene)
    : FrameSetup(resolve_options(given, scene), scene) {}

void FrameSetup::require_own_blockers() const {
  if (!blocked_by_view()) return;
  throw Error(ExitCode::usage,
              "light: found blockers '{}', which a frame's G-buffer makes, allowed: scene",
              name_of(options.blockers));
}

bool FrameSetup::injects_at_once() const {
  const std::size_t cascades = options.cascades;
  return sweeps() && options.layout != Layout::image && cascades <= rsms_together() &&
         cascades * stored_bytes(options.format(), injected_shape()) <= kAtOnce;
}

std::size_t FrameSetup::rsms_together() const {
  const std::size_t texels = std::size_t(options.rsm_size) * options.rsm_size;
  return std::max<std::size_t>(kAtOnce / (kRsmTexel * texels), 1);
}

int FrameSetup::geometry_volumes(bool masked) const {
  if (!options.blocked() || (links_by_points() && !masked)) return 0;
  return options.blockers == Blockers::scene ? options.cascades : 1;
}

}  // namespace clpv
