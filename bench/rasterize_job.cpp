// SPDX-License-Identifier: MIT
// Job of stage `rasterize`: RSMs, shadow maps or the camera's G-buffer.
#include "bench/rasterize_job.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "pathtracer/ray_scene.hpp"
#include "pipeline/frame/cascade.hpp"
#include "pipeline/raster/rasterize.hpp"
#include "pipeline/raster/view.hpp"
#include "reference/view.hpp"
#include "support/error.hpp"

namespace clpv::bench {
namespace {

// Depths of every kCheckedTexels-th pixel are compared with traced rays. The rasteriser snaps
// corners to 1/256 pixel, so depths differ at edges and on surfaces at grazing angles; the error is
// the share of pixels that differ.
constexpr std::size_t kCheckedTexels = 31;
constexpr double kDepthTolerance = 1e-2, kMaxDifferentShare = 0.02;

}  // namespace

double RasterTask::pixels() const {
  double sum = 0;
  for (const ClpvView& view : views) sum += static_cast<double>(view.width) * view.height;
  return sum;
}

RasterTask make_task(std::shared_ptr<const SceneData> scene, const std::string& camera_name,
                     Pass pass, const RenderOptions& options) {
  const SceneCamera& camera = scene->camera(camera_name);
  const Bounds bounds = bounds_of(scene->vertices, scene->triangles);
  RasterTask task{std::move(scene), pass, {}, {}};
  if (pass == Pass::rasterize_camera) {
    task.views = {camera_view(camera, options.width, options.height)};
    return task;
  }
  const std::vector<SceneLight> lights = task.scene->lights_for(camera);
  if (lights.empty())
    throw Error(ExitCode::bad_input, "{}: no light; bench needs one", task.scene->name);
  task.light = lights.front().data;
  if (pass == Pass::rasterize_shadow) {
    task.views = shadow_views(task.light, bounds, options.shadow_size);
    return task;
  }
  for (const ClpvGrid& grid :
       cascade_grids(camera.eye, options.cascades, options.cascade_size, options.grid)) {
    const std::vector<ClpvView> cascade_views =
        rsm_views(task.light, grid, bounds, options.rsm_size);
    task.views.insert(task.views.end(), cascade_views.begin(), cascade_views.end());
    if (!rsm_follows_cascade(task.light)) break;
  }
  return task;
}

namespace {

struct Rasterization {
  RasterTask task;
  SceneBuffers buffers;
  Rasterizer rasterizer;
  std::vector<Surface> surfaces;  ///< one per view; empty for shadow maps
  std::vector<Buffer> depths;     ///< one per view

  Rasterization(Session& session, RasterTask raster_task)
      : task(std::move(raster_task)),
        buffers(upload_scene(session, *task.scene)),
        rasterizer(session, buffers) {
    for (const ClpvView& view : task.views) {
      if (task.pass == Pass::rasterize_shadow) {
        depths.push_back(
            session.buffer(std::size_t{view.width} * view.height * sizeof(float), "shadow map"));
      } else {
        surfaces.push_back(make_surface(session, view, RsmFormat::float32, false));
        depths.push_back(surfaces.back().depth);
      }
    }
  }

  void draw() {
    for (std::size_t v = 0; v < task.views.size(); ++v) {
      if (task.pass == Pass::rasterize_camera) rasterizer.rasterize_camera(surfaces[v]);
      if (task.pass == Pass::rasterize_rsm) rasterizer.rasterize_rsm(task.light, surfaces[v]);
      if (task.pass == Pass::rasterize_shadow)
        rasterizer.rasterize_shadow(task.views[v], depths[v]);
    }
  }
};

/// Numbers of checked pixels, and of those whose depth differs from that of the ray through their
/// centre.
struct DepthComparison {
  double checked = 0, different = 0;
  std::string place;  ///< place of the last difference
};

void compare(DepthComparison& comparison, const pathtracer::RayScene& rays, Pass pass,
             const ClpvView& v, const std::vector<float>& depth) {
  const pathtracer::Faces faces =
      pass == Pass::rasterize_camera ? pathtracer::Faces::culled : pathtracer::Faces::all;
  for (std::size_t i = 0; i < depth.size(); i += kCheckedTexels) {
    const auto at = [&](double behind) {
      return glm::vec3(reference::surface_position(v, i % v.width, i / v.width, behind));
    };
    const auto hit = rays.intersect(at(0), at(1) - at(0), v.near_depth, v.far_depth, faces);
    const double ray_depth = hit ? hit->distance : 0;
    comparison.checked += 1;
    if (std::abs(depth[i] - ray_depth) <= kDepthTolerance * ray_depth) continue;
    comparison.different += 1;
    comparison.place = fmt::format("pixel {}: depth {:.7g}, ray {:.7g}", i, depth[i], ray_depth);
  }
}

}  // namespace

Deviation compare_with_rays(const RasterTask& task, const std::vector<std::vector<float>>& depths) {
  const pathtracer::RayScene rays(*task.scene);
  DepthComparison comparison;
  for (std::size_t v = 0; v < depths.size(); ++v)
    compare(comparison, rays, task.pass, task.views[v], depths[v]);
  return {comparison.different / comparison.checked, kMaxDifferentShare, comparison.place};
}

Cost cost_of(const RasterTask& task) {
  const SceneData& scene = *task.scene;
  const double pixel =
      task.pass == Pass::rasterize_shadow ? sizeof(float) : sizeof(float) + 2 * sizeof(cl_float4);
  Cost cost;
  cost.bytes =
      static_cast<double>(task.views.size() * (scene.vertices.size() * sizeof(ClpvVertex) +
                                               scene.triangles.size() * sizeof(ClpvTriangle))) +
      task.pixels() * pixel;
  cost.working_set = cost.bytes;
  cost.triangles = static_cast<double>(task.views.size() * scene.triangles.size());
  cost.pixels = task.pixels();
  return cost;
}

Job rasterize_job(Session& session, std::shared_ptr<const SceneData> scene,
                  const std::string& camera, Pass pass, const RenderOptions& options) {
  pathtracer::require_rays(ExitCode::device);  // else rows that are not checked
  const auto r =
      std::make_shared<Rasterization>(session, make_task(std::move(scene), camera, pass, options));
  const auto bytes = [r](std::size_t v) {
    return std::size_t{r->task.views[v].width} * r->task.views[v].height * sizeof(float);
  };
  Job job;
  job.reset = [r, &session, bytes] {
    for (std::size_t v = 0; v < r->depths.size(); ++v) session.fill_zero(r->depths[v], bytes(v));
  };
  job.run = [r] { r->draw(); };
  const auto read_depths = [r, &session, bytes] {
    std::vector<std::vector<float>> depths;
    for (std::size_t v = 0; v < r->depths.size(); ++v)
      depths.push_back(session.read<float>(r->depths[v], bytes(v) / sizeof(float)));
    return depths;
  };
  job.compare = [r, read_depths] { return compare_with_rays(r->task, read_depths()); };
  job.cost = cost_of(r->task);
  job.count = [r, read_depths](Cost& cost) {
    RasterCounts counts;
    r->rasterizer.count(&counts);
    r->draw();
    r->rasterizer.count(nullptr);
    cost.set_up = counts.set_up, cost.listed = counts.listed, cost.entries = counts.entries;
    for (const std::vector<float>& depths : read_depths())
      cost.covered += depths.size() - std::ranges::count(depths, 0.0f);
  };
  return job;
}

}  // namespace clpv::bench
