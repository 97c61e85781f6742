// SPDX-License-Identifier: MIT
#include "baselines/view.hpp"

#include "pipeline/view.hpp"
#include "reference/view.hpp"

namespace clpv::baselines {

View::View(const Scene& scene, const SceneCamera& camera, int width, int height, int bounces, int threads)
    : scene_(scene),
      rays_(scene),
      emitters_(scene, rays_.materials()),
      sky_(scene.sky.get()),
      lights_(scene.lights_for(camera)),
      threads_(threads),
      surfaces_(kSurfacePlanes, static_cast<std::size_t>(width) * height) {
  options_.bounces = bounces;
  image_.view = camera_view(camera, width, height);
  const std::size_t pixels = std::size_t{image_.view.width} * image_.view.height;
  hits_.resize(pixels);
  image_.depth.assign(pixels, 0);
  for (auto* layer : {&image_.normal, &image_.albedo, &image_.emissive, &image_.direct, &image_.irradiance})
    layer->assign(pixels, glm::vec3(0));
  parallel_for(pixels, image_.view.width,
               [&](reference::PathSampler& sampler, std::size_t first, std::size_t last) {
                 for (std::size_t i = first; i < last; ++i) {
                   const auto x = static_cast<unsigned>(i % image_.view.width),
                              y = static_cast<unsigned>(i / image_.view.width);
                   hits_[i] = sampler.primary_hit(image_.view, x, y);
                   if (!hits_[i]) continue;
                   const reference::Hit& hit = *hits_[i];
                   image_.depth[i] = hit.distance;
                   image_.normal[i] = hit.normal;
                   image_.albedo[i] = rays_.materials().albedo(hit.point, footprint(image_.view, x, y, hit));
                   for (int c = 0; c < 3; ++c) {
                     surfaces_[kPosition + c][i] = hit.position[c];
                     surfaces_[kNormal + c][i] = hit.normal[c];
                   }
                   surfaces_[kDensity][i] =
                       static_cast<float>(1 / reference::pixel_edge(image_.view, double{hit.distance}));
                 }
               });
}

reference::TracedImage View::with(const Irradiance& irradiance) const {
  reference::TracedImage image = image_;
  for (std::size_t i = 0; i < irradiance.size(); ++i) image.irradiance[i] = irradiance.at(i);
  return image;
}

}  // namespace clpv::baselines
