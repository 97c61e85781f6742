// SPDX-License-Identifier: MIT
#include "baselines/view.hpp"

#include <numbers>

#include "pipeline/raster/view.hpp"
#include "reference/view.hpp"

namespace clpv::baselines {

View::Shared::Shared(const SceneData& of, const SceneCamera& camera, int bounces, int use_threads)
    : scene(of),
      rays(of),
      emitters(of, rays.materials()),
      sky(of.sky.get()),
      lights(of.lights_for(camera)),
      threads(use_threads),
      eye(camera.eye) {
  options.bounces = bounces;
}

View::View(const SceneData& scene, const SceneCamera& camera, int width, int height, int bounces,
           int threads)
    : shared_(std::make_shared<Shared>(scene, camera, bounces, threads)),
      width_(static_cast<unsigned>(width)),
      height_(static_cast<unsigned>(height)),
      hits_(std::size_t{width_} * height_),
      surfaces_(kSurfacePlanes, hits_.size()) {
  pathtracer::TracedImage& image = shared_->image;
  image.view = camera_view(camera, width, height);
  image.depth.assign(hits_.size(), 0);
  for (auto* layer :
       {&image.normal, &image.albedo, &image.emissive, &image.direct, &image.irradiance})
    layer->assign(hits_.size(), glm::vec3(0));
  parallel_for(
      hits_.size(), width_,
      [&](pathtracer::PathSampler& sampler, std::size_t first, std::size_t last) {
        for (std::size_t i = first; i < last; ++i) {
          const auto x = static_cast<unsigned>(i % width_), y = static_cast<unsigned>(i / width_);
          hits_[i] = sampler.primary_hit(image.view, x, y);
          if (!hits_[i]) continue;
          const pathtracer::Hit& hit = *hits_[i];
          image.depth[i] = hit.distance;
          image.normal[i] = hit.normal;
          image.albedo[i] = rays().materials().albedo(hit.point, footprint(image.view, x, y, hit));
          for (int c = 0; c < 3; ++c) {
            surfaces_[kPosition + c][i] = hit.position[c];
            surfaces_[kNormal + c][i] = hit.normal[c];
          }
          surfaces_[kDensity][i] =
              static_cast<float>(1 / reference::pixel_edge(image.view, double{hit.distance}));
        }
      });
}

View::View(const View& full, unsigned stride)
    : shared_(full.shared_),
      width_((full.width_ + stride - 1) / stride),
      height_((full.height_ + stride - 1) / stride),
      stride_(stride),
      hits_(std::size_t{width_} * height_),
      surfaces_(kSurfacePlanes, hits_.size()) {
  for (std::size_t i = 0; i < hits_.size(); ++i) {
    const unsigned x = std::min(static_cast<unsigned>(i % width_) * stride + stride / 2,
                                full.width_ - 1),
                   y = std::min(static_cast<unsigned>(i / width_) * stride + stride / 2,
                                full.height_ - 1);
    const std::size_t from = std::size_t{y} * full.width_ + x;
    hits_[i] = full.hits_[from];
    for (std::size_t plane = 0; plane < kSurfacePlanes; ++plane)
      surfaces_[plane][i] = full.surfaces_[plane][from];
    surfaces_[kDensity][i] /= static_cast<float>(stride);
  }
}

View View::thinned(unsigned stride) const {
  return {*this, stride};
}

std::optional<View::Arriving> View::radiance(pathtracer::PathSampler& sampler,
                                             const glm::vec3& origin, const glm::vec3& direction,
                                             float furthest) const {
  const auto hit = rays().intersect(origin, direction, 0, furthest, pathtracer::Faces::all);
  if (!hit) return std::nullopt;
  glm::dvec3 sum = sampler.direct({*hit}) * std::numbers::inv_pi;
  if (sum != glm::dvec3(0)) sum *= glm::dvec3(rays().materials().albedo(hit->point));
  if (!emitters().empty()) sum += emitters().radiance(hit->point, -glm::dvec3(direction));
  return Arriving{glm::vec3(sum), hit->distance};
}

glm::vec3 View::sky_radiance(const glm::vec3& direction) const {
  return sky().empty() ? glm::vec3(0) : glm::vec3(sky().radiance(glm::dvec3(direction)));
}

pathtracer::TracedImage View::with(const Irradiance& irradiance) const {
  pathtracer::TracedImage image = shared_->image;
  for (std::size_t i = 0; i < irradiance.size(); ++i) image.irradiance[i] = irradiance.at(i);
  return image;
}

}  // namespace clpv::baselines
