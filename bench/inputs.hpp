// SPDX-License-Identifier: MIT
// Inputs of the benchmarked stages: RSMs and G-buffer of a scene, and the volumes injected from them.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "device/session.hpp"
#include "options/render_options.hpp"
#include "pipeline/inject/inject.hpp"
#include "pipeline/raster/rasterize.hpp"
#include "pipeline/raster/scene_buffers.hpp"
#include "pipeline/raster/surface.hpp"
#include "reference/volume.hpp"
#include "scene/scene.hpp"

namespace clpv::bench {

/// RSMs and G-buffer of one scene, rasterised on the device once. Texels within rounding of a cell boundary (about 0.1 %)
/// are emptied, so that a stage and its CPU reference assign every texel to the same cell.
class Inputs {
 public:
  /// Rasterises `scene` from `camera` and from the first light that applies there. `options` gives sizes and cascades. Throws
  /// Error(bad_input) if no light applies.
  Inputs(Session& session, const Scene& scene, const SceneCamera& camera, const RenderOptions& options);

  /// Views of one cascade, on the device and on the host.
  struct CascadeViews {
    ClpvGrid grid{};
    Surface rsm, camera;  ///< the RSM in the options' format
    SurfaceImage rsm_image, camera_image;
  };
  const CascadeViews& views(int cascade) const { return views_.at(cascade); }
  std::vector<ClpvGrid> grids() const;

  /// Injected light volume and geometry volume of a cascade in a basis, blocking one-sided as published. Volume's host order:
  /// channel, coefficient, z, y, x. Computed at the first call.
  const std::vector<float>& light(const Basis& basis, int cascade) { return injected(basis, cascade).light; }
  const std::vector<float>& geometry(const Basis& basis, int cascade) {
    return injected(basis, cascade).geometry;
  }
  /// Areas blocked by the scene's triangles in a cascade, at cell corners, as the sweep by default takes them. Same order,
  /// computed at the first call.
  const std::vector<float>& areas(int cascade);

 private:
  struct InjectedVolumes {
    std::vector<float> light, geometry;
  };
  const InjectedVolumes& injected(const Basis& basis, int cascade);

  Session& session_;
  RenderOptions options_;
  SceneBuffers scene_;
  std::vector<CascadeViews> views_;
  std::map<std::pair<std::string, int>, InjectedVolumes> injected_;
  std::map<int, std::vector<float>> areas_;
};

/// The volume of the CPU reference with `values` in Volume's host order; n^3 samples of `channels` x `coefficients` numbers.
reference::Volume to_reference(const std::vector<float>& values, int n, int coefficients, int channels);

}  // namespace clpv::bench
