// SPDX-License-Identifier: MIT
// Baseline: radiance cascades. Settings without a reason here were searched (docs/lab/experiments.md).
#include "baselines/radiance_cascades.hpp"

#include <cmath>
#include <limits>
#include <numbers>

#include "kernels/shared/grid.h"

namespace clpv::baselines {
namespace {

constexpr unsigned kFaces = 12;        // of HEALPix
constexpr unsigned kChildren = 4;      // directions of the next cascade in one of this
constexpr float kVisibleFrom = 1e-3f;  // [cells]: a probe on the surface of a pixel sees it
constexpr std::uint64_t kAxisBits = 21, kAxisOffset = 1 << 20;

std::uint64_t key_of(const glm::ivec3& cell) {
  const glm::u64vec3 c(cell + int(kAxisOffset));
  return c.x | c.y << kAxisBits | c.z << 2 * kAxisBits;
}

/// Calls action(corner, weight) for the eight cells around a position given in cells; weights are trilinear.
template <typename Action>
void for_each_corner(const glm::vec3& at, const Action& action) {
  const glm::vec3 low = glm::floor(at), f = at - low;
  for (int i = 0; i < 8; ++i) {
    const glm::ivec3 offset(i & 1, i >> 1 & 1, i >> 2);
    const glm::vec3 share = glm::mix(1.0f - f, f, glm::vec3(offset));
    action(glm::ivec3(low) + offset, share.x * share.y * share.z);
  }
}

/// Position of a cell's centre in cells of the next cascade, which are twice as large; their centres are at whole numbers.
glm::vec3 in_next(const glm::ivec3& cell) {
  return 0.5f * glm::vec3(cell) - 0.25f;
}

}  // namespace

std::vector<glm::vec3> healpix_directions(unsigned side) {
  constexpr std::array<unsigned, kFaces> kRing = {2, 2, 2, 2, 3, 3, 3, 3, 4, 4, 4, 4},
                                         kMeridian = {1, 3, 5, 7, 0, 2, 4, 6, 1, 3, 5, 7};
  const int n = static_cast<int>(side);
  std::vector<glm::vec3> directions;
  for (unsigned face = 0; face < kFaces; ++face) {
    for (int y = 0; y < n; ++y) {
      for (int x = 0; x < n; ++x) {
        const int ring = static_cast<int>(kRing[face]) * n - x - y - 1;
        const bool cap = ring < n || ring > 3 * n;
        const int length = ring < n       ? ring
                           : ring > 3 * n ? 4 * n - ring
                                          : n;  // a quarter of the ring's pixels
        const double from_pole = double(length) * length / (3.0 * n * n);
        const double z = !cap ? (2.0 * n - ring) * 2 / (3.0 * n) : ring < n ? 1 - from_pole : from_pole - 1;
        const int shift = cap ? 0 : (ring - n) & 1;
        const double place = (static_cast<int>(kMeridian[face]) * length + x - y + 1 + shift) / 2;
        const double angle = (place - (shift + 1) * 0.5) * std::numbers::pi / (2 * length),
                     across = std::sqrt(std::max(0.0, 1 - z * z));
        directions.emplace_back(across * std::cos(angle), across * std::sin(angle), z);
      }
    }
  }
  return directions;
}

std::size_t RadianceCascades::child(std::size_t direction, unsigned side, unsigned which) {
  const std::size_t face = direction / (side * side), x = direction % side, y = direction / side % side;
  return face * kChildren * side * side + (2 * y + (which >> 1)) * 2 * side + 2 * x + (which & 1);
}

glm::vec3 RadianceCascades::centre(const Cascade& cascade, const glm::ivec3& cell) const {
  return origin_ + (glm::vec3(cell) + 0.5f) * cascade.cell;
}

glm::vec3 RadianceCascades::pixel_in_cells(std::size_t pixel) const {
  return (view_.hits()[pixel]->position - origin_) / cascades_[0].cell - 0.5f;
}

RadianceCascades::RadianceCascades(const View& view, const glm::vec3& origin, float cell,
                                   std::vector<char> pixels, const RadianceCascadeSettings& settings)
    : view_(view), origin_(origin), pixels_(std::move(pixels)), settings_(settings) {
  float from = 0, length = settings.first * cell;
  for (unsigned i = 0; i < settings.cascades; ++i, from += length, length *= settings.ratio) {
    const bool last = i + 1 == settings.cascades;
    cascades_.push_back({.cell = std::ldexp(cell, static_cast<int>(i)),
                         .side = settings.side << i,
                         .from = from,
                         .to = last ? std::numeric_limits<float>::infinity() : from + length});
  }
  find_probes();
}

/// Finds the probes around pixels, then those of each next cascade around them.
void RadianceCascades::find_probes() {
  const auto add = [](Cascade& cascade, const glm::vec3& at) {
    for_each_corner(at, [&](const glm::ivec3& cell, float) {
      if (cascade.index.try_emplace(key_of(cell), cascade.probes.size()).second)
        cascade.probes.push_back(cell);
    });
  };
  for (std::size_t pixel = 0; pixel < pixels_.size(); ++pixel)
    if (pixels_[pixel]) add(cascades_[0], pixel_in_cells(pixel));
  for (std::size_t i = 0; i + 1 < cascades_.size(); ++i)
    for (const glm::ivec3& cell : cascades_[i].probes) add(cascades_[i + 1], in_next(cell));
}

/// Mean radiance of the next cascade's probe in the directions within one of this cascade.
glm::vec3 RadianceCascades::children_of(const Cascade& next, std::size_t probe, std::size_t direction) const {
  const glm::vec3* radiance = &next.radiance[probe * kFaces * next.side * next.side];
  glm::vec3 sum(0);
  for (unsigned i = 0; i < kChildren; ++i) sum += radiance[child(direction, next.side / 2, i)];
  return sum / float(kChildren);
}

/// Traces a cascade's intervals and merges them with the next cascade, if there is one.
void RadianceCascades::trace(Cascade& cascade, const Cascade* next) {
  const std::vector<glm::vec3> directions = healpix_directions(cascade.side);
  cascade.radiance.resize(cascade.probes.size() * directions.size());
  constexpr std::size_t kGrain = 4;
  view_.parallel_for(
      cascade.probes.size(), kGrain,
      [&](reference::PathSampler& sampler, std::size_t first, std::size_t last) {
        const auto along = [&](const glm::vec3& from, const glm::vec3& to) {
          const float length = glm::length(to - from);
          return view_.radiance(sampler, from, (to - from) / length, length);
        };
        for (std::size_t probe = first; probe < last; ++probe) {
          const glm::vec3 at = centre(cascade, cascade.probes[probe]);
          for (std::size_t d = 0; d < directions.size(); ++d) {
            glm::vec3& radiance = cascade.radiance[probe * directions.size() + d];
            const glm::vec3 start = at + cascade.from * directions[d];
            if (!next) {
              radiance = view_.radiance(sampler, start, directions[d], cascade.to)
                             .value_or(view_.sky_radiance(directions[d]));
              continue;
            }
            const auto straight =
                settings_.bilinear_fix ? std::nullopt : along(start, at + cascade.to * directions[d]);
            radiance = straight.value_or(glm::vec3(0));
            if (straight) continue;
            for_each_corner(in_next(cascade.probes[probe]), [&](const glm::ivec3& cell, float weight) {
              const std::size_t upper = next->index.at(key_of(cell));
              const auto blocked = settings_.bilinear_fix
                                       ? along(start, centre(*next, cell) + cascade.to * directions[d])
                                       : std::nullopt;
              radiance += weight * (blocked ? *blocked : children_of(*next, upper, d));
            });
          }
        }
      });
}

/// Irradiance at a pixel: cosine-weighted mean over the directions of the probes around it that see it, or of all where none
/// does.
glm::vec3 RadianceCascades::sample(std::size_t pixel, const std::vector<glm::vec3>& directions) const {
  const Cascade& cascade = cascades_[0];
  const reference::Hit& hit = *view_.hits()[pixel];
  const glm::vec3 from = view_.rays().offset_origin(hit);
  std::array<glm::vec2, 8> weights;  // of the seen, of all
  std::array<std::size_t, 8> probes;
  glm::vec2 total(0);
  unsigned i = 0;
  for_each_corner(pixel_in_cells(pixel), [&](const glm::ivec3& cell, float weight) {
    const glm::vec3 to = centre(cascade, cell) - from;
    const bool seen = glm::dot(to, hit.normal) > -kVisibleFrom * cascade.cell &&
                      !(settings_.visibility && view_.rays().occluded(from, to, 1));
    weights[i] = {seen ? weight : 0, weight};
    probes[i] = cascade.index.at(key_of(cell));
    total += weights[i++];
  });
  const int used = total.x > 0 ? 0 : 1;
  glm::vec3 sum(0);
  float cosines = 0;
  for (std::size_t d = 0; d < directions.size(); ++d) {
    const float cosine = glm::dot(directions[d], hit.normal);
    if (cosine <= 0) continue;
    glm::vec3 radiance(0);
    for (i = 0; i < 8; ++i)
      radiance += weights[i][used] * cascade.radiance[probes[i] * directions.size() + d];
    sum += cosine * radiance, cosines += cosine;
  }
  return std::numbers::pi_v<float> * sum / (cosines * total[used]);
}

void RadianceCascades::render(Irradiance& image) {
  for (std::size_t i = cascades_.size(); i-- > 0;)
    trace(cascades_[i], i + 1 < cascades_.size() ? &cascades_[i + 1] : nullptr);
  const std::vector<glm::vec3> directions = healpix_directions(cascades_[0].side);
  view_.for_each_pixel([&](reference::PathSampler&, std::size_t pixel) {
    if (pixels_[pixel]) image.set(pixel, sample(pixel, directions));
  });
}

std::size_t RadianceCascades::bytes() const {
  std::size_t sum = 0;
  for (const Cascade& cascade : cascades_) sum += cascade.radiance.size() * sizeof(glm::vec3);
  return sum;
}

CascadedImage radiance_cascades(const View& view, const std::vector<ClpvGrid>& grids,
                                const RadianceCascadeSettings& settings) {
  CascadedImage result{Irradiance(view.hits().size())};
  std::vector<char> taken(view.hits().size(), 0);
  for (const ClpvGrid& grid : grids) {
    const glm::vec3 origin(grid.origin[0], grid.origin[1], grid.origin[2]);
    std::vector<char> pixels(taken.size(), 0);
    for (std::size_t pixel = 0; pixel < taken.size(); ++pixel) {
      if (!view.hits()[pixel] || taken[pixel]) continue;
      const glm::vec3 at = (view.hits()[pixel]->position - origin) / grid.cell - 0.5f;
      const bool inside = glm::all(glm::greaterThanEqual(at, glm::vec3(0))) &&
                          glm::all(glm::lessThan(at, glm::vec3(static_cast<float>(grid.n - 1))));
      taken[pixel] = pixels[pixel] = inside;
    }
    RadianceCascades cascades(view, origin, settings.spacing * grid.cell, std::move(pixels), settings);
    cascades.render(result.irradiance);
    result.bytes += cascades.bytes();
    result.probes += cascades.probes();
  }
  view.for_each_pixel([&](reference::PathSampler&, std::size_t pixel) {
    if (!taken[pixel]) result.irradiance.set(pixel, glm::vec3(0));
  });
  return result;
}

}  // namespace clpv::baselines
