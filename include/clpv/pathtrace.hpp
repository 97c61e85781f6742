// SPDX-License-Identifier: MIT
// Ground truth by path tracing on the CPU.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "clpv/image.hpp"
#include "clpv/renderer.hpp"
#include "clpv/scene.hpp"

namespace clpv {

struct TraceOptions {
  int width = 960, height = 540;  ///< 1 to 16384
  int bounces = 0;  ///< maximum number of reflections between light and visible surface; 0: all
  std::uint32_t samples = 0;  ///< paths per pixel, up to 2^24; 0: as many as `noise` needs
  double noise = 0.02;     ///< relative standard error of the indirect light at which tracing stops
  std::uint64_t seed = 1;  ///< the same seed gives the same image
  int threads = 0;         ///< up to 1024; 0: one per processor
  double seconds = 0;      ///< time in the scene's animation [s]
  /// Receives the estimated progress in [0, 1], from one thread at a time. An exception from it
  /// ends the work and reaches the caller.
  std::function<void(double)> progress{};
};

/// Traces the image that Renderer::render() of the same view and camera estimates: diffuse
/// surfaces, hard shadows, one ray per pixel through its centre, R, G, B, A. Metadata has
/// `spp_traced`, `noise_reached` and the camera. Throws Error: usage (camera, options out of
/// range), bad_input (a scene without surface or light). Thread-safe.
Image pathtrace(const Scene& scene, View view, const CameraChoice& camera = {},
                const TraceOptions& options = {});
/// Several views of the same paths as layers: channel "indirect.R", as of `clpv pathtrace`. A
/// single view gets no layer name. Also throws Error(usage) if `views` is empty or lists a view
/// twice.
Image pathtrace(const Scene& scene, const std::vector<View>& views, const CameraChoice& camera = {},
                const TraceOptions& options = {});

/// Irradiance [W/m^2] of small surfaces: red, green, blue of each.
struct PointLights {
  std::vector<std::array<float, 3>> indirect;  ///< from surfaces, emission included, and the sky
  std::vector<std::array<float, 3>> direct;    ///< from the scene's lights
  std::vector<std::array<float, 3>> error;     ///< standard error of `indirect`
  std::uint32_t samples = 0;                   ///< paths per point
  double noise = 0;  ///< root mean square of `error` over that of `indirect`
};

/// Traces the irradiance at positions [m] with a normal (of any length) each, or one for all, on a
/// surface of the scene or in the air, lit by all lights; `indirect` is what Renderer::irradiance()
/// estimates. Uses neither width nor height of `options`. Throws Error: usage (options, different
/// numbers of positions and normals, more than 2^20 points, vectors that are not finite, positions
/// beyond +-1e7 m, a normal of length 0), bad_input (a scene without surface). Thread-safe.
PointLights pathtrace_points(const Scene& scene, std::span<const std::array<float, 3>> positions,
                             std::span<const std::array<float, 3>> normals,
                             const TraceOptions& options = {});

}  // namespace clpv
