// SPDX-License-Identifier: MIT
// Baseline: path tracing.
#include "baselines/methods.hpp"
#include "basis/sampling.hpp"

namespace clpv::baselines {

Irradiance trace_paths(const View& view, unsigned samples) {
  constexpr std::uint64_t kSeed = 2;  // the ground truth has other paths: its seed is 1
  Irradiance image(view.hits().size());
  view.for_each_pixel([&](pathtracer::PathSampler& sampler, std::size_t pixel) {
    glm::dvec3 sum(0);
    for (unsigned path = 0; path < samples; ++path)
      sum += sampler.indirect({*view.hits()[pixel]}, path, mix(mix(kSeed), pixel));
    image.set(pixel, glm::vec3(sum / double(samples)));
  });
  return image;
}

}  // namespace clpv::baselines
