// SPDX-License-Identifier: MIT
#include "search/normal_weights.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>

#include "pipeline/frame/cascade.hpp"
#include "pipeline/raster/rasterize.hpp"
#include "pipeline/raster/scene_buffers.hpp"
#include "pipeline/raster/surface.hpp"
#include "pipeline/raster/view.hpp"

namespace clpv {
namespace {

constexpr int kSide = 4;  // patches per edge of a cube face: a search uses at most 96 directions

/// Returns the patch index of direction `n` on a cube about the origin.
std::size_t patch_of(const glm::dvec3& n) {
  int axis = 0;
  for (int other = 1; other < 3; ++other) {
    if (std::abs(n[other]) > std::abs(n[axis])) axis = other;
  }
  const auto place = [&](double value) {
    return std::clamp(static_cast<int>((value / std::abs(n[axis]) + 1) / 2 * kSide), 0, kSide - 1);
  };
  const int face = 2 * axis + (n[axis] < 0 ? 1 : 0);
  return static_cast<std::size_t>((face * kSide + place(n[(axis + 1) % 3])) * kSide +
                                  place(n[(axis + 2) % 3]));
}

/// Sums of flux and of flux times normal per patch.
class Patches {
 public:
  void add(const SurfaceImage& rsm) {
    for (std::size_t i = 0; i < rsm.depth.size(); ++i) {
      const glm::dvec3 n(rsm.normal[i]), colour(rsm.colour[i]);
      const double flux = colour.x + colour.y + colour.z, length = glm::length(n);
      if (!(rsm.depth[i] > 0 && flux > 0 && length > 0)) continue;
      Patch& patch = patches_[patch_of(n / length)];
      patch.flux += flux;
      patch.normal += flux * n / length;
    }
  }
  std::vector<WeightedDirection> weights() const {
    double total = 0;
    for (const Patch& patch : patches_) total += patch.flux;
    std::vector<WeightedDirection> weights;
    for (const Patch& patch : patches_) {
      if (patch.flux > 0) weights.push_back({glm::normalize(patch.normal), patch.flux / total});
    }
    return weights;
  }

 private:
  struct Patch {
    double flux = 0;
    glm::dvec3 normal{0};
  };
  std::array<Patch, 6 * kSide * kSide> patches_{};
};

}  // namespace

std::vector<WeightedDirection> normal_weights(Session& session, const SceneData& scene,
                                              const SceneCamera& camera,
                                              const RenderOptions& options) {
  const SceneBuffers buffers = upload_scene(session, scene);
  Rasterizer rasterizer(session, buffers);
  Patches patches;
  const std::vector<ClpvGrid> grids =
      cascade_grids(camera.eye, options.cascades, options.cascade_size, options.grid);
  for (const SceneLight& light : scene.lights_for(camera)) {
    // All cascades share the maps of a light that is not a sun.
    const std::size_t cascades = light.data.kind == CLPV_LIGHT_DIRECTIONAL ? grids.size() : 1;
    for (std::size_t cascade = 0; cascade < cascades; ++cascade) {
      for (const ClpvView& view :
           rsm_views(light.data, grids[cascade], buffers.bounds, options.rsm_size)) {
        Surface rsm = make_surface(session, view, RsmFormat::float32, false);
        rasterizer.rasterize_rsm(light.data, rsm);
        patches.add(read_surface(session, rsm));
      }
    }
  }
  return patches.weights();
}

std::string to_json(const std::vector<WeightedDirection>& weights) {
  nlohmann::json list = nlohmann::json::array();
  for (const auto& [n, weight] : weights) list.push_back({n.x, n.y, n.z, weight});
  return nlohmann::json{{"weights", list}}.dump(1) + "\n";
}

}  // namespace clpv
