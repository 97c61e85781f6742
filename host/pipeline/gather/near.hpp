// SPDX-License-Identifier: MIT
// Stage `near`: traces rays for light from surfaces nearer than a cell, and replaces the volumes'
// (kernels/gather/near.cl).
#pragma once

#include <CL/opencl.hpp>
#include <future>
#include <map>
#include <optional>
#include <vector>

#include "basis/basis.hpp"
#include "device/kernel.hpp"
#include "device/session.hpp"
#include "options/stage_options.hpp"
#include "pipeline/gather/gather.hpp"
#include "pipeline/gather/triangle_tree.hpp"
#include "pipeline/raster/scene_buffers.hpp"
#include "pipeline/raster/shadow_maps.hpp"
#include "pipeline/raster/surface.hpp"

namespace clpv {

class NearField {
 public:
  /// `basis`: of the gathered light. `scene` must outlive this object; it and `buffers` must be at
  /// the same time. Starts a thread that builds the tree of triangles.
  NearField(Session& session, const Basis& basis, const SceneData& scene,
            const SceneBuffers& buffers, const NearOptions& options);

  /// Waits for the tree and uploads it, once. Call before the scene changes; trace() calls it.
  /// Throws Error(run_time) if Embree fails or device memory does not suffice.
  void finish();

  /// Call after positions of the scene changed.
  void move();

  /// Traces the rays of what `camera` sees (points without a view are allowed), in the grids that
  /// `gatherer` gathered from last. Hits stay valid while camera, triangles and grids are the same.
  void trace(const Surface& camera, const Gatherer& gatherer);

  /// Corrects the irradiance that `gatherer` gathered last for `camera`, by the hits of the last
  /// trace().
  void add(const Surface& camera, const Gatherer& gatherer,
           const std::vector<ShadowedLight>& lights, Buffer& irradiance);

 private:
  void reserve(const ClpvView& view);
  std::size_t rays_of_tile() const;
  void light_hits(const Surface& camera, const Gatherer& gatherer,
                  const std::vector<ShadowedLight>& lights);
  Kernel& set_hits(Kernel& kernel, const ClpvView& view, bool fresh);
  struct PixelKernels {  ///< those that read the camera's surface
    Kernel first;
    std::optional<Kernel> others;  ///< with step > 1
    Kernel add;
  };
  PixelKernels& pixel_kernels(bool points);

  Session& session_;
  const SceneData& scene_;
  const SceneBuffers& buffers_;
  NearOptions options_;
  std::future<TriangleTree> building_;
  std::optional<TriangleTree> tree_;  ///< none until finish()
  bool uploaded_ = false;
  Kernel trace_, light_, emit_, near_, blur_, widen_;
  ProgramSource points_source_, filter_source_;
  std::map<bool, PixelKernels> pixel_kernels_;  ///< by Surface::points()
  std::optional<Kernel> reflect_;               ///< with more than one bounce
  Buffer nodes_, leaves_, directions_;
  Buffer points_, distances_, counts_, hits_, radiances_, near_light_, blurred_;
  std::size_t width_ = 0, height_ = 0;  ///< near pixels that the buffers have, of both layers
};

}  // namespace clpv
