// SPDX-License-Identifier: MIT
// Baselines: other methods for indirect light of one view, on the CPU with Embree. Each takes a
// number of samples, and returns the same bytes for the same number with any number of threads.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "baselines/view.hpp"
#include "image/image.hpp"
#include "kernels/shared/grid.h"

namespace clpv::baselines {

/// Path tracing with `samples` paths per pixel.
Irradiance trace_paths(const View& view, unsigned samples);

/// Virtual point light (VPL): a small disc.
struct PointLight {
  glm::vec3 position, normal;  ///< [m]; lifted off its surface for shadow rays
  glm::vec3 flux;              ///< [W]
  float area;                  ///< lit surface per light [m^2]
};

/// Draws VPLs of equal flux from RSMs (Keller, 'Instant Radiosity', SIGGRAPH 1997; Dachsbacher and
/// Stamminger, 'Reflective Shadow Maps', I3D 2005). Empty if no surface is lit.
std::vector<PointLight> draw_lights(std::span<const SurfaceImage> rsms, unsigned count);

/// Irradiance from VPLs with a shadow ray each. `interleave` n: pixel (x, y) takes only lights (x
/// mod n) + n (y mod n) of each n^2, weighted to represent all (Keller and Heidrich, 'Interleaved
/// Sampling', EGWR 2001). VPLs are treated as discs, which clamps the singularity: flux cos cos' /
/// (pi d^2 + area) (Wallace et al., SIGGRAPH 1989).
Irradiance light_by(const View& view, std::span<const PointLight> lights, unsigned interleave);

/// Irradiance probes with visibility at the centres of cascades' cells (DDGI; Majercik et al.,
/// 'Dynamic Diffuse Global Illumination with Ray-Traced Irradiance Fields', JCGT 8(2), 2019). A
/// pixel takes the finest cascade whose probes enclose it; only probes that pixels take are traced.
/// One bounce.
class Probes {
 public:
  Probes(const View& view, std::vector<ClpvGrid> grids) : view_(view), grids_(std::move(grids)) {}

  /// Renders the next frame: finds the probes that pixels need, traces `rays` of each, blends the
  /// results with those of earlier frames, and returns the irradiance of all pixels. The first
  /// frame has no history.
  Irradiance render(unsigned rays);

  std::size_t count() const { return positions_.size(); }  ///< probes of the last frame

 private:
  struct Corner {  ///< the probes around a pixel
    std::uint32_t first = 0;
    glm::vec3 fraction{0};  ///< position between them
    int grid = -1;          ///< none: no cascade encloses the pixel
  };
  void find_probes();
  void trace(unsigned rays);
  glm::vec3 sample(std::size_t pixel) const;

  const View& view_;
  std::vector<ClpvGrid> grids_;
  unsigned frame_ = 0;
  std::vector<Corner> corners_;                   ///< one per pixel
  std::vector<std::vector<std::int32_t>> slots_;  ///< number of each cell's probe, or -1, by grid
  std::vector<glm::vec3> positions_;
  std::vector<float> limits_;  ///< largest distance that counts, per probe [m]
  /// Cosine-weighted mean radiance [W/m^2/sr], kLightTexels^2 per probe.
  std::vector<glm::vec3> radiance_;
  /// Mean distance [m] and squared distance, kDistanceTexels^2 per probe.
  std::vector<glm::vec2> distance_;
};

}  // namespace clpv::baselines
