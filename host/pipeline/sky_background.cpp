// SPDX-License-Identifier: MIT
#include "pipeline/sky_background.hpp"

#include <glm/glm.hpp>

namespace clpv {
namespace {

glm::dvec3 triple(const float (&v)[3]) {
  return {v[0], v[1], v[2]};
}

}  // namespace

void paint_sky(const Sky& sky, const ClpvView& view, std::vector<float>& image) {
  const glm::dvec3 forward = triple(view.forward), right = triple(view.right), up = triple(view.up);
  for (unsigned y = 0; y < view.height; ++y) {
    for (unsigned x = 0; x < view.width; ++x) {
      float* pixel = &image[std::size_t{4} * (std::size_t{y} * view.width + x)];
      if (pixel[3] != 0) continue;
      glm::dvec3 ray = forward;
      if (view.orthographic == 0) {
        ray += (2 * (x + 0.5) / view.width - 1) * double{view.half_width} * right +
               (1 - 2 * (y + 0.5) / view.height) * double{view.half_height} * up;
      }
      const glm::vec3 seen = sky.seen(glm::normalize(ray));
      for (int channel = 0; channel < 3; ++channel) pixel[channel] = seen[channel];
      pixel[3] = 1;
    }
  }
}

}  // namespace clpv
