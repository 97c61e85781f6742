// SPDX-License-Identifier: MIT
// Rasterises and injects the inputs of the benchmarked stages.
#include "bench/inputs.hpp"

#include <algorithm>

#include "pipeline/frame/cascade.hpp"
#include "pipeline/inject/inject.hpp"
#include "pipeline/raster/rasterize.hpp"
#include "pipeline/raster/scene_buffers.hpp"
#include "pipeline/raster/view.hpp"
#include "pipeline/voxels/blockers.hpp"
#include "reference/inject.hpp"
#include "support/error.hpp"
#include "volume/volume.hpp"

namespace clpv::bench {
namespace {

constexpr double kMargin = 1e-4;  // [cells]: about 100 roundings of a position in a cascade

/// Returns true if rounding decides the cell of a point.
bool near_boundary(const glm::dvec3& point) {
  const glm::dvec3 off = glm::abs(point - glm::round(point));
  return std::min({off.x, off.y, off.z}) < kMargin;
}

/// Returns `image` without texels near a boundary of a light cell or a geometry cell.
SurfaceImage without_boundary_texels(SurfaceImage image, const ClpvGrid& grid) {
  for (std::size_t i = 0; i < image.depth.size(); ++i) {
    if (image.depth[i] <= 0) continue;
    const bool light = near_boundary(reference::grid_point(image, i, grid, true));
    if (light || near_boundary(reference::grid_point(image, i, grid, false) + 0.5))
      image.depth[i] = 0;
  }
  return image;
}

}  // namespace

Inputs::Inputs(Session& session, const SceneData& scene, const SceneCamera& camera,
               const RenderOptions& options)
    : session_(session), options_(options), scene_(upload_scene(session, scene)) {
  const std::vector<SceneLight> lights = scene.lights_for(camera);
  if (lights.empty()) throw Error(ExitCode::bad_input, "{}: no light; bench needs one", scene.name);
  Rasterizer rasterizer(session, scene_);
  Surface surface = make_surface(session, camera_view(camera, options.width, options.height),
                                 RsmFormat::float32, false);
  rasterizer.rasterize_camera(surface);
  const SurfaceImage image = read_surface(session, surface);
  for (const ClpvGrid& grid :
       cascade_grids(camera.eye, options.cascades, options.cascade_size, options.grid)) {
    Surface rsm = make_surface(
        session, rsm_views(lights.front().data, grid, scene_.bounds, options.rsm_size).front(),
        options.rsm_format, false);
    rasterizer.rasterize_rsm(lights.front().data, rsm);
    views_.push_back(
        {grid,
         verify::upload_injected(session, without_boundary_texels(read_surface(session, rsm), grid),
                                 options.rsm_format, rsm.colour_scale),
         verify::upload_injected(session, without_boundary_texels(image, grid),
                                 RsmFormat::float32)});
  }
}

std::vector<ClpvGrid> Inputs::grids() const {
  std::vector<ClpvGrid> grids;
  for (const CascadeViews& views : views_) grids.push_back(views.grid);
  return grids;
}

const Inputs::InjectedVolumes& Inputs::injected(const Basis& basis, int cascade) {
  const auto [entry, made] = injected_.try_emplace({basis.name(), cascade});
  if (made) {
    const int grid = options_.grid;
    Injector injector(session_, basis, InjectOptions{.grid = grid});
    Volume light(session_, {grid, basis.size(), 3}, "bench: injected light");
    Volume geometry(session_, {grid + 1, basis.size(), 1}, "bench: geometry volume");
    const CascadeViews& source = views(cascade);
    injector.inject_light(source.rsm.surface, source.grid, light);
    injector.inject_geometry(source.rsm.surface, source.grid, geometry);
    injector.inject_geometry(source.camera.surface, source.grid, geometry);
    entry->second = {to_host(light), to_host(geometry)};
  }
  return entry->second;
}

verify::SharedVolume Inputs::areas(int cascade) {
  const auto [entry, made] = areas_.try_emplace(cascade);
  if (made) {
    Volume geometry(session_, {options_.grid + 1, 3, 1}, "bench: geometry volume");
    VoxelField(session_, scene_, blocker_masks(scene_, options_.grid, 1, {}))
        .update(0, views(cascade).grid, geometry);
    entry->second = to_host(geometry);
  }
  return entry->second;
}

verify::SharedVolume Inputs::to_host(const Volume& volume) {
  const auto& [n, coefficients, channels] = volume.shape();
  const auto copy = std::make_shared<reference::Volume>(n, coefficients, channels);
  const std::vector<float> values = volume.read(session_);
  copy->values.assign(values.begin(), values.end());
  return copy;
}

}  // namespace clpv::bench
