// SPDX-License-Identifier: MIT
// Sampling of one pixel or point: primary hit, direct irradiance, and single paths of indirect
// irradiance and of scattered light.
#pragma once

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <optional>
#include <vector>

#include "kernels/shared/view.h"
#include "pathtracer/emitters.hpp"
#include "pathtracer/path_tracer.hpp"
#include "pathtracer/ray_scene.hpp"
#include "reference/lighting.hpp"

namespace clpv::pathtracer {

/// Light that reaches the start of a path from one direction.
struct Arrival {
  glm::dvec3 direction{0};  ///< unit, towards the light
  glm::dvec3 light{0};      ///< one path's estimate of radiance times PathSampler::Vertex's factor
};

/// Borrows its arguments. Each thread has its own, for its count of rays.
class PathSampler {
 public:
  /// Point of a path. Light that arrives there counts times a factor.
  struct Vertex {
    enum class Kind {
      surface,  ///< a surface of the scene: factor cosine
      element,  ///< a small surface that is not the scene's: factor cosine
      probe,    ///< factor 1/4, so that the sum over directions is pi times the mean radiance
      medium,   ///< factor pi times the phase function
    };
    Hit hit;  ///< element: position, geometric and normal; probe and medium: position
    Kind kind = Kind::surface;
    glm::dvec3 arrived{0};  ///< in the medium: unit direction in which the path reached it
  };

  /// `medium`: null without one.
  PathSampler(const RayScene& rays, const std::vector<SceneLight>& lights, const Emitters& emitters,
              const SkySampler& sky, const ClpvMedium* medium, const PathTracerOptions& options)
      : rays_(rays),
        lights_(lights),
        emitters_(emitters),
        sky_(sky),
        medium_(medium),
        options_(options) {}

  /// The surface at a pixel's centre; `distance` is its depth. Empty without a surface.
  std::optional<Hit> primary_hit(const ClpvView& view, std::uint32_t px, std::uint32_t py);

  /// Irradiance from the scene's lights [W/m^2]; in the medium pi times the integral of phase
  /// function and radiance.
  glm::dvec3 direct(const Vertex& at);

  /// One path's estimate of the irradiance at `start` from surfaces, emission included, from the
  /// medium and from the sky [W/m^2]. Paths 0, 1, 2... of a stream are a low-discrepancy sequence;
  /// streams are independent of each other.
  glm::dvec3 indirect(const Vertex& start, std::uint32_t path, std::uint64_t stream);
  /// The same by direction: light of a sampled emitter, of a sampled part of the sky, and of the
  /// rest of the path.
  std::array<Arrival, 3> arriving(const Vertex& start, std::uint32_t path, std::uint64_t stream);

  /// Light of the scene's lights at a position [m] that no surface shadows.
  std::vector<reference::Incident> lights_at(const glm::vec3& position);

  /// One path's estimate of the radiance [W/m^2/sr] that the medium scatters towards `origin` along
  /// the first `distance` [m] of a ray. Needs a medium.
  glm::dvec3 scattered_towards(const glm::dvec3& origin, const glm::dvec3& direction,
                               double distance, std::uint32_t path, std::uint64_t stream);

  std::uint64_t ray_count() const { return ray_count_; }

 private:
  /// The channel for which free flights of a path are sampled, and their density for each channel
  /// up to a factor.
  struct Flights {
    int channel;
    glm::dvec3 density;

    /// Takes the densities of a flight, and divides the throughput by the mean of the products.
    void take(const glm::dvec3& more, glm::dvec3& throughput);
  };

  static int channel_of(std::uint32_t path, std::uint64_t stream);
  std::array<Arrival, 3> arriving(const Vertex& start, std::uint32_t path, std::uint64_t stream,
                                  Flights flights);
  static Vertex in_medium(const glm::dvec3& origin, const glm::dvec3& direction, double distance);
  glm::vec3 origin_of(const Vertex& at) const;
  double factor(const Vertex& at, const glm::dvec3& direction) const;
  glm::dvec3 transmitted(const glm::vec3& origin, const glm::dvec3& direction,
                         double distance) const;
  std::optional<glm::vec3> sample_direction(const Vertex& at, const glm::dvec2& random) const;
  std::optional<double> fly(const glm::vec3& origin, const glm::dvec3& direction, double distance,
                            double random, Flights& flights, glm::dvec3& throughput) const;
  glm::dvec3 from_beams(const glm::dvec3& origin, const glm::dvec3& direction, double distance,
                        double random);
  Arrival sample_emitter(const Vertex& at, const glm::dvec2& random);
  Arrival sample_sky(const Vertex& at, const glm::dvec2& random);
  glm::dvec3 sky_along(const Vertex& at, const glm::dvec3& direction) const;
  glm::dvec3 emission_of(const Vertex& at, const glm::dvec3& direction, const Hit& next) const;
  bool shadowed(const ClpvLight& light, const glm::vec3& origin, const glm::dvec3& towards) const;

  const RayScene& rays_;
  const std::vector<SceneLight>& lights_;
  const Emitters& emitters_;
  const SkySampler& sky_;
  const ClpvMedium* medium_;
  const PathTracerOptions& options_;
  std::uint64_t ray_count_ = 0;
};

}  // namespace clpv::pathtracer
