// SPDX-License-Identifier: MIT
// Path tracing at points: irradiance of small surfaces, and integrals of the light that arrives at
// probes. The ground truth for light at points, as trace_paths is for images.
#pragma once

#include <cstdint>
#include <functional>
#include <glm/glm.hpp>
#include <memory>
#include <span>
#include <vector>

#include "pathtracer/path_tracer.hpp"
#include "scene/input.hpp"

namespace clpv::pathtracer {

inline constexpr std::size_t kMaxTracedPoints = std::size_t{1} << 20;  ///< 240 bytes each

/// Irradiance of a small surface [W/m^2].
struct PointLight {
  glm::dvec3 direct{0};    ///< from the scene's lights, exact
  glm::dvec3 indirect{0};  ///< from surfaces, the sky and the medium
  glm::dvec3 error{0};     ///< standard error of `indirect`; NaN with one path
};

struct TracedPoints {
  std::vector<PointLight> points;
  std::uint32_t samples = 0;  ///< paths per point
  double noise = 0;           ///< root mean square of `error` over that of `indirect`
  std::uint64_t rays = 0;
};

/// Weights g_i of integrals c_i = Int L(w) g_i(w) dw of the radiance L that arrives from w.
struct Moments {
  std::size_t count = 0;
  std::function<void(const glm::dvec3& w, std::span<double> g)> weights;
};

/// Integrals at probes: [probe][integral], red, green, blue.
struct TracedProbes {
  std::vector<glm::dvec3> indirect, error;  ///< as PointLight
  std::uint32_t samples = 0;
  double noise = 0;  ///< root mean square of `error` over `level`
  double level = 0;  ///< root mean square of `indirect`, or the one given
  std::uint64_t rays = 0;
};

/// Holds the scene's acceleration structure. Borrows nothing. Results do not depend on the number
/// of threads, nor on which points a call has.
class PointTracer {
 public:
  /// Throws Error(bad_input) for a scene without surfaces, Error(usage) for options out of range.
  PointTracer(const SceneData& scene, const std::vector<SceneLight>& lights,
              const PathTracerOptions& options);
  ~PointTracer();

  /// Points within surface_distance() of a surface lie on it, as pixels do, on the side to which
  /// their normal points, or on its front if the normal points along it; others in the air.
  TracedPoints irradiance(std::span<const SurfacePoint> points, const TraceProgress& progress = {});

  /// Positions on a surface lie on its front, here and below. `first`: number of the first position
  /// among all of them. `level`: see TracedProbes; 0: these positions' own.
  TracedProbes probes(std::span<const glm::dvec3> positions, const Moments& moments,
                      std::uint64_t first = 0, double level = 0,
                      const TraceProgress& progress = {});

  /// Root mean square of these integrals, from few paths.
  double level(std::span<const glm::dvec3> positions, const Moments& moments);

  /// The same integrals of the light of the scene's lights, which has no width.
  std::vector<glm::dvec3> direct(std::span<const glm::dvec3> positions, const Moments& moments);

  /// Share of directions whose first hit is the back of a surface, and of those without a hit.
  struct Surroundings {
    double backs = 0, open = 0;
  };
  std::vector<Surroundings> surroundings(std::span<const glm::dvec3> positions);

  /// Moves positions that are nearer than `distance` [m] to surfaces to that distance, on their own
  /// side, but at most half-way to what lies there.
  std::vector<glm::dvec3> off_surfaces(std::span<const glm::dvec3> positions, double distance);

  /// The nearest point of a surface along a ray, with the normal on its side; false without one.
  bool hit(const glm::dvec3& origin, const glm::dvec3& direction, SurfacePoint& found);

  double surface_distance() const;  ///< [m] 1e-5 of the scene's largest edge

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace clpv::pathtracer
