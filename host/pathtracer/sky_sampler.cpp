// SPDX-License-Identifier: MIT
#include "pathtracer/sky_sampler.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>

#include "pathtracer/sampling.hpp"

namespace clpv::reference {
namespace {

/// Makes sums shares of the last one, which is returned.
double to_shares(std::span<double> sums) {
  const double all = sums.back();
  if (all > 0) {
    for (double& sum : sums) sum /= all;
  }
  return all;
}

}  // namespace

double SkySampler::weight(std::size_t texel) const {
  const glm::vec3& radiance = sky_->texels[texel];
  return double{std::max({radiance.x, radiance.y, radiance.z})};
}

SkySampler::SkySampler(const Sky* sky) : sky_(sky) {
  if (sky == nullptr || !(sky->brightest() > 0)) return;
  const auto width = static_cast<std::size_t>(sky->width);
  for (int y = 0; y < sky->height; ++y) {
    const std::size_t first = upto_column_.size();
    double sum = 0;
    for (std::size_t x = 0; x < width; ++x) upto_column_.push_back(sum += weight(first + x));
    const double row = to_shares(std::span(upto_column_).subspan(first));
    all_ += row * sky->solid_angle(y);
    upto_row_.push_back(all_);
  }
  to_shares(upto_row_);
}

SkyDirection SkySampler::pick(const glm::dvec2& at) const {
  const auto width = static_cast<std::size_t>(sky_->width);
  const ShareIn row = find_share(upto_row_, at.y);
  const ShareIn column = find_share(std::span(upto_column_).subspan(row.index * width, width), at.x);
  const double top = std::cos(std::numbers::pi * static_cast<double>(row.index) / sky_->height),
               bottom = std::cos(std::numbers::pi * static_cast<double>(row.index + 1) / sky_->height);
  const double up = top + row.within * (bottom - top);  // even over the texel's solid angle
  const double y = std::acos(std::clamp(up, -1.0, 1.0)) / std::numbers::pi * sky_->height;
  const std::size_t texel = row.index * width + column.index;
  return {sky_->direction(static_cast<double>(column.index) + column.within, y),
          glm::dvec3(sky_->texels[texel]), weight(texel) / all_};
}

double SkySampler::density(const glm::dvec3& direction) const {
  return weight(sky_->texel_at(direction)) / all_;
}

}  // namespace clpv::reference
