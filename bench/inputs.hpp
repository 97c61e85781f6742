// SPDX-License-Identifier: MIT
// Inputs of the benchmarked stages: RSMs and G-buffer of a scene, and the volumes injected from
// them.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "device/session.hpp"
#include "options/render_options.hpp"
#include "pipeline/raster/scene_buffers.hpp"
#include "scene/scene.hpp"
#include "verify/inject.hpp"
#include "volume/volume.hpp"

namespace clpv::bench {

/// RSMs and G-buffer of one scene, rasterised on the device once. Texels within rounding of a cell
/// boundary (about 0.1 %) are emptied, so that a stage and its CPU reference assign every texel to
/// the same cell.
class Inputs {
 public:
  /// Rasterises `scene` from `camera` and from the first light that applies there. `options` gives
  /// sizes and cascades. Throws Error(bad_input) if no light applies.
  Inputs(Session& session, const SceneData& scene, const SceneCamera& camera,
         const RenderOptions& options);

  /// Surfaces of one cascade.
  struct CascadeViews {
    ClpvGrid grid{};
    verify::InjectedSurface rsm, camera;  ///< the RSM in the options' format
  };
  const CascadeViews& views(int cascade) const { return views_.at(cascade); }
  std::vector<ClpvGrid> grids() const;

  /// Injected light volume and geometry volume of a cascade in a basis, blocking one-sided as
  /// published. Computed at the first call.
  verify::SharedVolume light(const Basis& basis, int cascade) {
    return injected(basis, cascade).light;
  }
  verify::SharedVolume geometry(const Basis& basis, int cascade) {
    return injected(basis, cascade).geometry;
  }
  /// Areas blocked by the scene's triangles in a cascade, at cell corners, as the sweep by default
  /// takes them. Computed at the first call.
  verify::SharedVolume areas(int cascade);

 private:
  struct InjectedVolumes {
    verify::SharedVolume light, geometry;
  };
  const InjectedVolumes& injected(const Basis& basis, int cascade);
  verify::SharedVolume to_host(const Volume& volume);

  Session& session_;
  RenderOptions options_;
  SceneBuffers scene_;
  std::vector<CascadeViews> views_;
  std::map<std::pair<std::string, int>, InjectedVolumes> injected_;
  std::map<int, verify::SharedVolume> areas_;
};

}  // namespace clpv::bench
