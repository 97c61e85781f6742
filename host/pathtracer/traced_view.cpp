// SPDX-License-Identifier: MIT
#include "pathtracer/traced_view.hpp"

#include <numbers>

namespace clpv::reference {
namespace {

glm::vec3 shown(const TracedImage& t, std::size_t i, Show show) {
  const glm::vec3 reflectance = t.albedo[i] * std::numbers::inv_pi_v<float>;
  switch (show) {
    case Show::full:
      return reflectance * (t.direct[i] + t.irradiance[i]) + t.emissive[i];
    case Show::direct:
      return reflectance * t.direct[i] + t.emissive[i];
    case Show::indirect:
      return reflectance * t.irradiance[i];
    case Show::irradiance:
      return t.irradiance[i];
    case Show::albedo:
      return t.albedo[i];
    case Show::normal:
      return t.normal[i];
    case Show::depth:
      return glm::vec3(t.depth[i]);
  }
  return glm::vec3(0);
}

}  // namespace

Image traced_view(const TracedImage& traced, Show show) {
  Image image = make_image(static_cast<int>(traced.view.width), static_cast<int>(traced.view.height),
                           {"R", "G", "B", "A"});
  for (std::size_t i = 0; i < image.pixel_count(); ++i) {
    const bool surface = traced.depth[i] > 0;
    if (!surface && !(traced.sky && shows_sky(show))) continue;
    const glm::vec3 colour = surface ? shown(traced, i, show) : traced.emissive[i];
    for (int c = 0; c < 3; ++c) image.pixels[4 * i + c] = colour[c];
    image.pixels[4 * i + 3] = 1;
  }
  return image;
}

}  // namespace clpv::reference
