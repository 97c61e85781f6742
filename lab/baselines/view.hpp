// SPDX-License-Identifier: MIT
// Data that all baselines share: a scene for ray queries, its lights, and the surfaces that a
// camera sees.
#pragma once

#include <algorithm>
#include <atomic>
#include <glm/glm.hpp>
#include <memory>
#include <optional>
#include <vector>

#include "pathtracer/emitters.hpp"
#include "pathtracer/path_sampler.hpp"
#include "pathtracer/path_tracer.hpp"
#include "pathtracer/ray_scene.hpp"
#include "pathtracer/tracing.hpp"
#include "scene/scene.hpp"

namespace clpv::baselines {

/// Numbers of pixels, one plane for each coordinate. Planes start in different sets of the cache,
/// so that reading the same pixel of all of them is fast.
class Planes {
 public:
  Planes(std::size_t count, std::size_t pixels)
      : pixels_(pixels),
        stride_((pixels / kPage + 1) * kPage + kShift),
        numbers_(count * stride_, 0) {}

  float* operator[](std::size_t plane) { return &numbers_[plane * stride_]; }
  const float* operator[](std::size_t plane) const { return &numbers_[plane * stride_]; }
  std::size_t size() const { return pixels_; }
  bool operator==(const Planes&) const = default;

 private:
  static constexpr std::size_t kPage = 1024, kShift = 17 * 16;  // 4096 bytes; 17 cache lines
  std::size_t pixels_, stride_;
  std::vector<float> numbers_;
};

/// Irradiance per pixel, row 0 first. Planes: red, green, blue [W/m^2], and 1 where it was
/// computed, 0 elsewhere.
struct Irradiance : Planes {
  explicit Irradiance(std::size_t pixels = 0) : Planes(4, pixels) {}
  glm::vec3 at(std::size_t i) const { return {(*this)[0][i], (*this)[1][i], (*this)[2][i]}; }
  bool computed(std::size_t i) const { return (*this)[3][i] > 0; }
  void set(std::size_t i, const glm::vec3& value) {
    for (int c = 0; c < 3; ++c) (*this)[c][i] = value[c];
    (*this)[3][i] = 1;
  }
};

/// Planes of the pixels' surfaces, as the joint bilateral filter compares them: position [m],
/// normal, and pixels per metre on a plane across the view. Normals are 0 without a surface.
inline constexpr std::size_t kPosition = 0, kNormal = 3, kDensity = 6, kSurfacePlanes = 7;

/// A camera's view of a scene, which it borrows; a medium is ignored. Baselines do not count the
/// time of its construction: clpv has the G-buffer too, and caches blockers as these methods may
/// cache the tree of triangles.
class View {
 public:
  /// `bounces` as in PathTracerOptions. Throws as RayScene.
  View(const SceneData& scene, const SceneCamera& camera, int width, int height, int bounces,
       int threads);

  /// View of one in `stride` x `stride` pixels, the middle ones.
  View thinned(unsigned stride) const;
  unsigned stride() const { return stride_; }  ///< 1: of all pixels

  const SceneData& scene() const { return shared_->scene; }
  const pathtracer::RayScene& rays() const { return shared_->rays; }
  const pathtracer::Emitters& emitters() const { return shared_->emitters; }
  const pathtracer::SkySampler& sky() const { return shared_->sky; }
  int threads() const { return shared_->threads; }
  int bounces() const { return shared_->options.bounces; }

  unsigned width() const { return width_; }
  unsigned height() const { return height_; }
  const glm::vec3& eye() const { return shared_->eye; }
  /// Surfaces of the pixels' centres: what the camera's ray hits, and its summary for the filter.
  const std::vector<std::optional<pathtracer::Hit>>& hits() const { return hits_; }
  const Planes& surfaces() const { return surfaces_; }

  struct Arriving {
    glm::vec3 radiance;  ///< [W/m^2/sr]
    float distance;      ///< [m]
  };
  /// Radiance that arrives from the nearest surface at origin + t direction, t in (0, furthest),
  /// and its distance t: emitted, and one reflection of the lights. Empty without a surface.
  std::optional<Arriving> radiance(pathtracer::PathSampler& sampler, const glm::vec3& origin,
                                   const glm::vec3& direction, float furthest) const;
  /// Radiance of the sky; 0 without one.
  glm::vec3 sky_radiance(const glm::vec3& direction) const;

  /// G-buffer of all pixels with this irradiance.
  pathtracer::TracedImage with(const Irradiance& irradiance) const;

  /// Calls action(sampler, first, last) for ranges of up to `grain` items that cover [0, count), on
  /// all threads.
  template <typename Action>
  void parallel_for(std::size_t count, std::size_t grain, const Action& action) const {
    std::atomic<std::size_t> next{0};
    pathtracer::on_threads(threads(), [&](const std::atomic<bool>& failed) {
      const Shared& s = *shared_;
      pathtracer::PathSampler sampler(s.rays, s.lights, s.emitters, s.sky, nullptr, s.options);
      for (std::size_t first; !failed && (first = next.fetch_add(grain)) < count;)
        action(sampler, first, std::min(count, first + grain));
    });
  }

  /// Calls action(sampler, pixel) for the pixels with a surface.
  template <typename Action>
  void for_each_pixel(const Action& action) const {
    parallel_for(hits_.size(), width_,
                 [&](pathtracer::PathSampler& sampler, std::size_t first, std::size_t last) {
                   for (std::size_t pixel = first; pixel < last; ++pixel) {
                     if (hits_[pixel]) action(sampler, pixel);
                   }
                 });
  }

 private:
  struct Shared {  ///< by all views of a scene from a camera
    const SceneData& scene;
    pathtracer::RayScene rays;
    pathtracer::Emitters emitters;
    pathtracer::SkySampler sky;
    std::vector<SceneLight> lights;
    pathtracer::PathTracerOptions options;
    int threads;
    glm::vec3 eye;
    pathtracer::TracedImage image;  ///< G-buffer of all pixels

    Shared(const SceneData& of, const SceneCamera& camera, int bounces, int use_threads);
  };
  View(const View& full, unsigned stride);

  std::shared_ptr<Shared> shared_;
  unsigned width_, height_, stride_ = 1;
  std::vector<std::optional<pathtracer::Hit>> hits_;
  Planes surfaces_;
};

}  // namespace clpv::baselines
