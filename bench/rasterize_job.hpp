// SPDX-License-Identifier: MIT
// Job of stage `rasterize`, and its parts for a job that draws the same by other means.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "bench/stage_jobs.hpp"
#include "kernels/shared/light.h"
#include "kernels/shared/view.h"

namespace clpv::bench {

/// One pass of rasterising: its scene, light and views.
struct RasterTask {
  std::shared_ptr<const SceneData> scene;
  Pass pass;
  ClpvLight light{};  ///< unused by rasterize_camera
  std::vector<ClpvView> views;

  double pixels() const;  ///< sum over all views
};

/// The task of rasterize_job(), with its errors.
RasterTask make_task(std::shared_ptr<const SceneData> scene, const std::string& camera, Pass pass,
                     const RenderOptions& options);

/// Share of pixels whose depth differs from that of the ray through their centre. `depths` [m]: of
/// each view, row by row from the top.
Deviation compare_with_rays(const RasterTask& task, const std::vector<std::vector<float>>& depths);

/// Compulsory traffic: vertices and triangles read once per view, every pixel written once.
Cost cost_of(const RasterTask& task);

/// Rasterises a scene for `camera` (empty: its first) and the first light that applies there.
/// `pass` is rasterize_camera (the camera's G-buffer), rasterize_shadow (shadow maps) or
/// rasterize_rsm (RSMs of all cascades). Throws Error(bad_input) if a pass needs a light and none
/// applies.
Job rasterize_job(Session& session, std::shared_ptr<const SceneData> scene,
                  const std::string& camera, Pass pass, const RenderOptions& options);

}  // namespace clpv::bench
