// SPDX-License-Identifier: MIT
// Path tracer: the ground truth for rendered images, pixel by pixel.
//
// Surfaces are diffuse. Lights are points, spots and suns without extent (hard shadows), emissive
// surfaces, and a sky. A pixel is one ray through its centre, as in the rasteriser, without
// antialiasing. Its indirect irradiance is
//   E = pi mean(L(w)) over cosine-distributed directions w, L(w) = L_emitted + albedo / pi
//   (E_direct + E of the next bounce) at the surface hit by w, or the sky's radiance.
// In a medium (kernels/shared/light.h) a path may scatter before it meets a surface, which counts
// as a bounce; and the medium scatters light towards the camera, L = integral of T sigma_s p L(w)
// over the ray and all directions. Light of emissive surfaces and of the sky is indirect: volumes
// carry it in the pipeline. Method: docs/quality.md.
#pragma once

#include <cstdint>
#include <functional>
#include <glm/glm.hpp>
#include <optional>
#include <vector>

#include "image/image.hpp"
#include "kernels/shared/view.h"
#include "options/show.hpp"
#include "parallel/ranks.hpp"
#include "scene/scene.hpp"

namespace clpv::pathtracer {

struct PathTracerOptions {
  static constexpr int kAllBounces = 0;
  static constexpr int kMaxThreads = 1024;
  static constexpr std::uint32_t kMaxSamples = 1u << 24;

  int bounces = 1;  ///< maximum number of surfaces before the visible one, emissive ones included,
                    ///< or kAllBounces
  std::uint32_t samples = 0;  ///< paths per pixel; 0: as many as `noise` needs
  double noise = 0.02;        ///< with samples 0: stops at this TracedImage::noise
  std::uint64_t seed = 1;
  int threads = 0;  ///< per rank, up to kMaxThreads; 0: one per available processor
};

/// A traced image: one value per pixel, row 0 first, 0 where there is no surface.
struct TracedImage {
  ClpvView view{};
  std::vector<float> depth;       ///< [m] along the view's forward axis
  std::vector<glm::vec3> normal;  ///< unit, towards the viewer
  std::vector<glm::vec3> albedo;
  std::vector<glm::vec3> emissive;  ///< radiance [W/m^2/sr]; the sky's where there is no surface
  bool sky = false;                 ///< true if the scene has a sky
  std::vector<glm::vec3> direct;    ///< irradiance from the scene's lights [W/m^2]
  /// Indirect irradiance, from other surfaces and the sky [W/m^2].
  std::vector<glm::vec3> irradiance;
  std::optional<ClpvMedium> medium;  ///< the scene's
  /// Radiance that the medium scatters towards the camera [W/m^2/sr].
  std::vector<glm::vec3> scattered;
  std::uint32_t samples = 0;  ///< paths per pixel
  /// Standard error of the indirect radiance: its root mean square over that of the image, all
  /// pixels and channels. The same of scattered radiance where that is larger. Estimated from two
  /// independent halves of the paths; NaN with one path.
  double noise = 0;
  std::uint64_t rays = 0;
};

/// Receives the estimated share of all paths that are traced, rising to 1 at the end. It is first
/// called when the number of paths for the noise can be estimated. Called on rank 0, by one thread
/// at a time. An exception from it ends the work and reaches the caller of trace_paths().
using TraceProgress = std::function<void(double)>;

/// Traces `scene` lit by `lights`, which replace SceneData::lights. All `ranks` call it; they share
/// tiles and halves of paths, and each returns the whole image. Its bytes do not depend on the
/// number of threads and ranks. Throws Error(bad_input) for a scene without surface or without
/// light, and for an eye where floats are farther apart than its near plane; Error(usage) for
/// options out of range.
TracedImage trace_paths(const SceneData& scene, const std::vector<SceneLight>& lights,
                        const ClpvView& view, const PathTracerOptions& options,
                        const TraceProgress& progress = {}, Ranks& ranks = single_rank());

/// R, G, B, A of one view, units and meaning as in kernels/shared/shade.h: alpha 1 where there is a
/// surface, else all 0.
Image traced_view(const TracedImage& traced, Show show);

}  // namespace clpv::pathtracer
