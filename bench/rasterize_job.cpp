// SPDX-License-Identifier: MIT
// Stage `rasterize` as a job: reflective shadow maps, shadow maps, or the camera's view; and its peer.
#include <fmt/format.h>

#include <cmath>

#include "bench/baseline/rasterize_gl.hpp"
#include "bench/stage_jobs.hpp"
#include "pathtracer/ray_scene.hpp"
#include "pipeline/cascade.hpp"
#include "pipeline/rasterize.hpp"
#include "pipeline/view.hpp"
#include "reference/view.hpp"
#include "support/error.hpp"

namespace clpv::bench {
namespace {

// Depths are held against rays through every so manieth pixel. Corners snap to 1/256 pixel, so that edges and surfaces
// seen at a slant differ: told by how many pixels differ at all.
constexpr std::size_t kCheckedTexels = 31;
constexpr double kSameDepth = 1e-2, kMostDifferent = 0.02;

/// What is rasterised: for one purpose, from some views.
struct Wanted {
  std::shared_ptr<const Scene> scene;
  Pass pass;
  ClpvLight light{};  ///< none for the camera
  std::vector<ClpvView> views;

  double pixels() const {
    double sum = 0;
    for (const ClpvView& view : views) sum += static_cast<double>(view.width) * view.height;
    return sum;
  }
};

Wanted wanted(std::shared_ptr<const Scene> scene, const std::string& camera_name, Pass pass,
              const RenderOptions& options) {
  const Camera& camera = scene->camera(camera_name);
  const Bounds bounds = bounds_of(scene->vertices, scene->triangles);
  Wanted w{std::move(scene), pass, {}, {}};
  if (pass == Pass::rasterize_camera) {
    w.views = {camera_view(camera, options.width, options.height)};
    return w;
  }
  const std::vector<Light> lights = w.scene->lights_for(camera);
  if (lights.empty()) throw Error(ExitCode::bad_input, "{}: no light shines; bench needs one", w.scene->name);
  w.light = lights.front().data;
  if (pass == Pass::rasterize_shadow) {
    w.views = shadow_views(w.light, bounds, options.shadow_size);
    return w;
  }
  for (const ClpvGrid& grid :
       cascade_grids(camera.eye, options.cascades, options.cascade_size, options.grid)) {
    const std::vector<ClpvView> of_cascade = rsm_views(w.light, grid, bounds, options.rsm_size);
    w.views.insert(w.views.end(), of_cascade.begin(), of_cascade.end());
    if (!rsm_follows_cascade(w.light)) break;
  }
  return w;
}

struct Rasterization {
  Wanted wanted;
  SceneBuffers buffers;
  Rasterizer rasterizer;
  std::vector<Surface> surfaces;  ///< of each view; none of shadow maps, which are depths alone
  std::vector<Buffer> depths;

  Rasterization(Session& session, Wanted what)
      : wanted(std::move(what)), buffers(upload_scene(session, *wanted.scene)), rasterizer(session, buffers) {
    for (const ClpvView& view : wanted.views) {
      if (wanted.pass == Pass::rasterize_shadow) {
        depths.push_back(session.buffer(std::size_t{view.width} * view.height * sizeof(float), "shadow map"));
      } else {
        surfaces.push_back(make_surface(session, view, RsmFormat::float32, false));
        depths.push_back(surfaces.back().depth);
      }
    }
  }

  void draw() {
    for (std::size_t v = 0; v < wanted.views.size(); ++v) {
      if (wanted.pass == Pass::rasterize_camera) rasterizer.rasterize_camera(surfaces[v]);
      if (wanted.pass == Pass::rasterize_rsm) rasterizer.rasterize_rsm(wanted.light, surfaces[v]);
      if (wanted.pass == Pass::rasterize_shadow) rasterizer.rasterize_shadow(wanted.views[v], depths[v]);
    }
  }
};

/// Checked pixels of a view, and those whose depth is not that of the ray through their centre.
struct Compared {
  double checked = 0, different = 0;
  std::string place;
};

void compare(Compared& compared, const reference::RayScene& rays, Pass pass, const ClpvView& v,
             const std::vector<float>& depth) {
  const reference::Faces faces =
      pass == Pass::rasterize_camera ? reference::Faces::as_seen : reference::Faces::both;
  for (std::size_t i = 0; i < depth.size(); i += kCheckedTexels) {
    const auto at = [&](double behind) {
      return glm::vec3(reference::surface_position(v, i % v.width, i / v.width, behind));
    };
    const auto hit = rays.intersect(at(0), at(1) - at(0), v.near_depth, v.far_depth, faces);
    const double found = hit ? hit->distance : 0;
    compared.checked += 1;
    if (std::abs(depth[i] - found) <= kSameDepth * found) continue;
    compared.different += 1;
    compared.place = fmt::format("pixel {}: depth {:.7g}, ray {:.7g}", i, depth[i], found);
  }
}

Deviation compare(const Wanted& wanted, const std::vector<std::vector<float>>& depths) {
  const reference::RayScene rays(*wanted.scene);
  Compared compared;
  for (std::size_t v = 0; v < depths.size(); ++v)
    compare(compared, rays, wanted.pass, wanted.views[v], depths[v]);
  return {compared.different / compared.checked, kMostDifferent, compared.place};
}

/// Vertices and triangles read once a view, what is found of each pixel written.
Cost cost_of(const Wanted& wanted) {
  const Scene& scene = *wanted.scene;
  const double pixel =
      wanted.pass == Pass::rasterize_shadow ? sizeof(float) : sizeof(float) + 2 * sizeof(cl_float4);
  Cost cost;
  cost.bytes = static_cast<double>(wanted.views.size() * (scene.vertices.size() * sizeof(ClpvVertex) +
                                                          scene.triangles.size() * sizeof(ClpvTriangle))) +
               wanted.pixels() * pixel;
  cost.working_set = cost.bytes;
  cost.triangles = static_cast<double>(wanted.views.size() * scene.triangles.size());
  cost.pixels = wanted.pixels();
  return cost;
}

}  // namespace

Job rasterize_job(Session& session, std::shared_ptr<const Scene> scene, const std::string& camera, Pass pass,
                  const RenderOptions& options) {
  const auto r = std::make_shared<Rasterization>(session, wanted(std::move(scene), camera, pass, options));
  const auto bytes = [r](std::size_t v) {
    return std::size_t{r->wanted.views[v].width} * r->wanted.views[v].height * sizeof(float);
  };
  Job job;
  job.reset = [r, &session, bytes] {
    for (std::size_t v = 0; v < r->depths.size(); ++v) session.fill_zero(r->depths[v], bytes(v));
  };
  job.run = [r] { r->draw(); };
  job.verify = [r, &session, bytes] {
    std::vector<std::vector<float>> depths;
    for (std::size_t v = 0; v < r->depths.size(); ++v)
      depths.push_back(session.read<float>(r->depths[v], bytes(v) / sizeof(float)));
    return compare(r->wanted, depths);
  };
  job.cost = cost_of(r->wanted);
  return job;
}

Job rasterize_gl_job(Session&, std::shared_ptr<const Scene> scene, const std::string& camera, Pass pass,
                     const RenderOptions& options) {
  const auto w = std::make_shared<Wanted>(wanted(std::move(scene), camera, pass, options));
  const auto gl = std::make_shared<GlRasterizer>(*w->scene, pass, w->views, w->light);
  Job job;
  job.own_stages = true;  // nothing runs on the device: wall time
  job.run = [gl] { gl->draw(); };
  if (pass != Pass::rasterize_shadow) job.verify = [gl, w] { return compare(*w, gl->depths()); };
  job.cost = cost_of(*w);
  return job;
}

}  // namespace clpv::bench
