// SPDX-License-Identifier: MIT
// Stage `near`: traces rays for light from surfaces nearer than a cell, and replaces the volumes' (kernels/gather/near.cl).
#pragma once

#include <CL/opencl.hpp>
#include <optional>
#include <vector>

#include "basis/basis.hpp"
#include "device/kernel.hpp"
#include "device/session.hpp"
#include "options/stage_options.hpp"
#include "pipeline/gather/gather.hpp"
#include "pipeline/raster/scene_buffers.hpp"
#include "pipeline/raster/shadow_maps.hpp"
#include "pipeline/raster/surface.hpp"
#include "pipeline/gather/triangle_tree.hpp"

namespace clpv {

class NearField {
 public:
  /// `basis`: of the gathered light. `scene` must outlive this object; it and `buffers` must be at
  /// the same time.
  NearField(Session& session, const Basis& basis, const Scene& scene, const SceneBuffers& buffers,
            const NearOptions& options);

  /// Call after positions of the scene changed.
  void move();

  /// Corrects the irradiance that `gatherer` gathered last for `camera`.
  void add(const Surface& camera, const Gatherer& gatherer, const std::vector<ShadowedLight>& lights,
           Buffer& irradiance);

 private:
  void upload_tree();
  void reserve(const ClpvView& view);
  void light_hits(const Surface& camera, const Gatherer& gatherer, const std::vector<ShadowedLight>& lights);
  Kernel& set_hits(Kernel& kernel, const ClpvView& view, bool fresh);

  Session& session_;
  const Scene& scene_;
  const SceneBuffers& buffers_;
  NearOptions options_;
  TriangleTree tree_;
  Kernel points_kernel_, trace_, light_, emit_, near_, blur_, widen_, add_;
  std::optional<Kernel> reflect_;  ///< with more than one bounce
  Buffer nodes_, leaves_, directions_;
  Buffer points_, distances_, counts_, hits_, radiances_, differences_, blurred_;
  std::size_t plane_ = 0;  ///< numbers of a plane of the buffers
};

}  // namespace clpv
