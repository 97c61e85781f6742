// SPDX-License-Identifier: MIT
// Path tracing in a scene: the truth that an image of the pipeline is held against, pixel by pixel.
//
// Every surface is diffuse; lights are points, spots and suns without extent (hard shadows), and surfaces that emit,
// and a sky beyond them all. A pixel is one
// ray through its centre, as in the rasteriser, so there is no antialiasing. Its indirect irradiance is
//   E = pi mean over cosine-distributed directions of the radiance L that arrives along them,
//   L = emission + albedo / pi (E_direct [+ E of the next bounce]) at the surface the direction meets.
// What a surface emits is thus counted as what it reflects of a light is; so is the sky, where the direction meets nothing.
#pragma once

#include <cstdint>
#include <functional>
#include <glm/glm.hpp>
#include <vector>

#include "image/image.hpp"
#include "kernels/shared/view.h"
#include "options/show.hpp"
#include "parallel/ranks.hpp"
#include "scene/scene.hpp"

namespace clpv::reference {

struct PathTracerOptions {
  static constexpr int kAllBounces = 0;
  static constexpr std::uint32_t kMostSamples = 1u << 24;

  int bounces =
      1;  ///< surfaces between a light and the surface seen, or kAllBounces; an emissive one is such a surface
  std::uint32_t samples = 0;  ///< paths a pixel; 0: as many as `noise` needs
  double noise = 0.02;        ///< where samples is 0: stops at this TracedImage::noise
  std::uint64_t seed = 1;
  int threads = 0;  ///< of each rank; 0: one a processor that it may take
};

/// One value a pixel, row 0 first; 0 where there is no surface.
struct TracedImage {
  ClpvView view{};
  std::vector<float> depth;       ///< [m] along the view's forward axis
  std::vector<glm::vec3> normal;  ///< unit, towards the viewer
  std::vector<glm::vec3> albedo;
  std::vector<glm::vec3> emissive;    ///< radiance [W/m^2/sr]; where there is no surface, the sky's
  bool sky = false;                   ///< the scene has one
  std::vector<glm::vec3> direct;      ///< irradiance straight from the lights [W/m^2]
  std::vector<glm::vec3> irradiance;  ///< irradiance from other surfaces [W/m^2]
  std::uint32_t samples = 0;          ///< paths a pixel
  /// Standard error of the indirect radiance: its root mean square over that of the image, all pixels and
  /// channels (so, the NRMSE that the reference itself adds). From two independently randomised halves; NaN
  /// with one sample.
  double noise = 0;
  std::uint64_t rays = 0;
};

/// Called now and then, at rank 0 by one thread at a time, with the estimated share done in [0, 1].
using TraceProgress = std::function<void(double)>;

/// `lights` shine, whatever Scene::lights holds (Scene::lights_for).
/// By all `ranks`, each of which has the image then: they share the tiles, and the two halves of their paths.
/// The same bytes for the same scene, lights, view, options and seed, whatever the number of threads and ranks.
/// Throws Error(bad_input) for a scene without surface or without light;
/// Error(usage) for options out of range.
TracedImage trace_paths(const Scene& scene, const std::vector<Light>& lights, const ClpvView& view,
                        const PathTracerOptions& options, const TraceProgress& progress = {},
                        Ranks& ranks = single_rank());

/// R, G, B, A of one view, units and meaning as in kernels/shared/shade.h: alpha 1 where there is a surface, else all 0.
Image traced_view(const TracedImage& traced, Show show);

}  // namespace clpv::reference
