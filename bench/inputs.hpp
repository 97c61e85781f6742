// SPDX-License-Identifier: MIT
// What stages work on in a benchmark: what a light and a camera see of a scene, and what injection makes of it.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "device/session.hpp"
#include "options/render_options.hpp"
#include "pipeline/inject.hpp"
#include "pipeline/rasterize.hpp"
#include "pipeline/scene_buffers.hpp"
#include "pipeline/surface.hpp"
#include "reference/volume.hpp"
#include "scene/scene.hpp"

namespace clpv::bench {

/// Views of one scene, rasterised on the device once. Texels within rounding of where their cell changes are emptied
/// (some per mille of them), so that a stage and its CPU reference put every one into the same cell.
class Inputs {
 public:
  /// Sees `scene` through `camera`, lit by the first light that shines there; sizes and cascades as `options` say. Throws
  /// Error(bad_input) without a light.
  Inputs(Session& session, const Scene& scene, const Camera& camera, const RenderOptions& options);

  struct Seen {
    ClpvGrid grid{};
    Surface rsm, camera;  ///< the RSM in the options' format
    SurfaceImage rsm_image, camera_image;
  };
  const Seen& seen(int cascade) const { return seen_.at(cascade); }
  std::vector<ClpvGrid> grids() const;

  /// Injected light and blocking of a cascade in a basis, the published way (one-sided), by layout `soa`
  /// in float: Volume's host order. Made once.
  const std::vector<float>& light(const Basis& basis, int cascade) { return injected(basis, cascade).light; }
  const std::vector<float>& geometry(const Basis& basis, int cascade) {
    return injected(basis, cascade).geometry;
  }
  /// What the scene's triangles block of a cascade, as areas: what the defaults' sweep takes. In the same order, made once.
  const std::vector<float>& areas(int cascade);

 private:
  struct Injected {
    std::vector<float> light, geometry;
  };
  const Injected& injected(const Basis& basis, int cascade);

  Session& session_;
  RenderOptions options_;
  SceneBuffers scene_;
  std::vector<Seen> seen_;
  std::map<std::pair<std::string, int>, Injected> injected_;
  std::map<int, std::vector<float>> areas_;
};

reference::Volume to_reference(const std::vector<float>& values, int n, int coefficients, int channels);

}  // namespace clpv::bench
