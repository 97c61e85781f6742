// SPDX-License-Identifier: MIT
// Stage `rasterize` as a job: a reflective shadow map, or the camera's view.
#include <fmt/format.h>

#include <cmath>

#include "bench/stage_jobs.hpp"
#include "pathtracer/ray_scene.hpp"
#include "pipeline/cascade.hpp"
#include "pipeline/rasterize.hpp"
#include "pipeline/view.hpp"
#include "support/error.hpp"

namespace clpv::bench {
namespace {

// Depths are held against rays through every so manieth pixel. Corners snap to 1/256 pixel, so that edges and surfaces
// seen at a slant differ: told by how many pixels differ at all.
constexpr std::size_t kCheckedTexels = 31;
constexpr double kSameDepth = 1e-2, kMostDifferent = 0.02;

struct Rasterization {
  std::shared_ptr<const Scene> scene;
  SceneBuffers buffers;
  Rasterizer rasterizer;
  ClpvLight light{};
  Surface surface;
  bool rsm;

  Rasterization(Session& session, std::shared_ptr<const Scene> lit, bool of_light,
                const RenderOptions& options)
      : scene(std::move(lit)),
        buffers(upload_scene(session, *scene)),
        rasterizer(session, buffers),
        rsm(of_light) {
    const Camera& camera = scene->camera({});
    ClpvView view = camera_view(camera, options.width, options.height);
    if (rsm) {
      const std::vector<Light> lights = scene->lights_for(camera);
      if (lights.empty())
        throw Error(ExitCode::bad_input, "{}: no light shines; bench needs one", scene->name);
      light = lights.front().data;
      const ClpvGrid grid = cascade_grids(camera.eye, 1, options.cascade_size, options.grid).front();
      view = rsm_views(light, grid, buffers.bounds, options.rsm_size).front();
    }
    surface = make_surface(session, view, RsmFormat::float32, false);
  }
};

/// Share of the checked pixels whose depth is not that of the ray through their centre.
Deviation compare(const Rasterization& r, const SurfaceImage& image) {
  const reference::RayScene rays(*r.scene);
  const ClpvView& v = image.view;
  const auto vec = [](const float(&a)[3]) { return glm::vec3(a[0], a[1], a[2]); };
  Deviation deviation{0, kMostDifferent, {}};
  double checked = 0, different = 0;
  for (std::size_t i = 0; i < image.depth.size(); i += kCheckedTexels) {
    const float sx =
        (2 * (static_cast<float>(i % v.width) + 0.5f) / static_cast<float>(v.width) - 1) * v.half_width;
    const float sy =
        (1 - 2 * (static_cast<float>(i / v.width) + 0.5f) / static_cast<float>(v.height)) * v.half_height;
    const glm::vec3 aside = sx * vec(v.right) + sy * vec(v.up);
    const bool parallel = v.orthographic > 0.5f;
    const auto hit = rays.intersect(vec(v.eye) + (parallel ? aside : glm::vec3(0)),
                                    vec(v.forward) + (parallel ? glm::vec3(0) : aside), v.near_depth,
                                    v.far_depth, r.rsm ? reference::Faces::both : reference::Faces::as_seen);
    const double wanted = hit ? hit->distance : 0;
    checked += 1;
    if (std::abs(image.depth[i] - wanted) <= kSameDepth * wanted) continue;
    different += 1;
    deviation.place = fmt::format("pixel {}: depth {:.7g}, ray {:.7g}", i, image.depth[i], wanted);
  }
  deviation.worst = different / checked;
  return deviation;
}

Job rasterize_job(Session& session, std::shared_ptr<const Scene> scene, bool rsm,
                  const RenderOptions& options) {
  const auto r = std::make_shared<Rasterization>(session, std::move(scene), rsm, options);
  const std::size_t pixels = std::size_t{r->surface.view.width} * r->surface.view.height;
  Job job;
  job.reset = [r, &session, pixels] { session.fill_zero(r->surface.depth, pixels * sizeof(float)); };
  job.run = [r] {
    if (r->rsm) {
      r->rasterizer.rasterize_rsm(r->light, r->surface);
    } else {
      r->rasterizer.rasterize_camera(r->surface);
    }
  };
  job.verify = [r, &session] { return compare(*r, read_surface(session, r->surface)); };
  job.cost.bytes = static_cast<double>(r->buffers.vertex_count) * sizeof(ClpvVertex) +
                   static_cast<double>(r->buffers.triangle_count) * sizeof(ClpvTriangle) +
                   static_cast<double>(pixels) * (sizeof(float) + 2 * sizeof(cl_float4));
  job.cost.working_set = job.cost.bytes;
  return job;
}

}  // namespace

Job rasterize_rsm_job(Session& session, std::shared_ptr<const Scene> scene, const RenderOptions& options) {
  return rasterize_job(session, std::move(scene), true, options);
}

Job rasterize_camera_job(Session& session, std::shared_ptr<const Scene> scene, const RenderOptions& options) {
  return rasterize_job(session, std::move(scene), false, options);
}

}  // namespace clpv::bench
