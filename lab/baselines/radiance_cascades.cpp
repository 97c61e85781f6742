// SPDX-License-Identifier: MIT
// Settings without a reason here were searched (lab/docs/experiments.md).
#include "baselines/radiance_cascades.hpp"

#include <cmath>
#include <limits>
#include <numbers>

namespace clpv::baselines {
namespace {

constexpr unsigned kFaces = 12;        // faces of HEALPix
constexpr unsigned kChildren = 4;      // directions of the next cascade in one of this
constexpr float kVisibleFrom = 1e-3f;  // [spacings]: a probe on the surface of a pixel sees it
constexpr float kInfinity = std::numeric_limits<float>::infinity();
constexpr std::uint64_t kAxisBits = 21, kAxisOffset = 1 << 20;

std::uint64_t key_of(const glm::ivec3& cell) {
  const glm::u64vec3 c(cell + int(kAxisOffset));
  return c.x | c.y << kAxisBits | c.z << 2 * kAxisBits;
}

/// The eight probes around a point and their trilinear weights, which sum to 1.
struct Corners {
  std::array<std::size_t, 8> probe;
  std::array<float, 8> weight;
};

/// Probes of one spacing with their radiance.
struct Cascade {
  float spacing;  ///< [m]; probes are at the centres of cells of this edge
  unsigned side;
  float from, to;                                        ///< interval [m]
  std::vector<glm::ivec3> cells;                         ///< one per probe
  std::vector<Corners> above;                            ///< probes of the next cascade around each
  std::unordered_map<std::uint64_t, std::size_t> index;  ///< probe by key_of() its cell
  std::vector<glm::vec4> radiance;  ///< each probe's, by direction; w 0: blocked before `from`

  /// Returns the eight probes around a position given in cells from the first cell's centre. Adds
  /// those that are missing.
  Corners around(const glm::vec3& at) {
    const glm::vec3 low = glm::floor(at), f = at - low;
    Corners corners;
    for (int i = 0; i < 8; ++i) {
      const glm::ivec3 offset(i & 1, i >> 1 & 1, i >> 2), cell = glm::ivec3(low) + offset;
      const glm::vec3 share = glm::mix(1.0f - f, f, glm::vec3(offset));
      const auto [found, added] = index.try_emplace(key_of(cell), cells.size());
      if (added) cells.push_back(cell);
      corners.probe[i] = found->second, corners.weight[i] = share.x * share.y * share.z;
    }
    return corners;
  }
};

/// Cascades over one grid, for the pixels that are not 0 in `pixels`.
class RadianceCascades {
 public:
  RadianceCascades(const View& view, const glm::vec3& origin, float spacing,
                   const std::vector<char>& pixels, const RadianceCascadeSettings& settings);

  void render(Irradiance& image);
  std::size_t bytes() const {
    std::size_t sum = 0;
    for (const Cascade& cascade : cascades_) sum += cascade.radiance.size() * sizeof(glm::vec4);
    return sum;
  }
  std::size_t probes() const { return cascades_[0].cells.size(); }

 private:
  glm::vec3 position(const Cascade& cascade, std::size_t probe) const {
    return origin_ + (glm::vec3(cascade.cells[probe]) + 0.5f) * cascade.spacing;
  }
  void trace(Cascade& cascade, const Cascade* next);
  Corners seen_from(const Cascade& cascade, std::size_t probe, const Cascade& next) const;
  std::optional<glm::vec3> merged(const Cascade& next, const Corners& corners,
                                  std::size_t direction) const;
  glm::vec3 sample(pathtracer::PathSampler& sampler, std::size_t pixel,
                   const Corners& corners) const;

  const View& view_;
  glm::vec3 origin_;
  RadianceCascadeSettings settings_;
  std::vector<Cascade> cascades_;
  std::vector<std::vector<glm::vec3>> directions_;  ///< by cascade, and of one finer than the last
  std::vector<std::pair<std::size_t, Corners>> pixels_;
};

RadianceCascades::RadianceCascades(const View& view, const glm::vec3& origin, float spacing,
                                   const std::vector<char>& pixels,
                                   const RadianceCascadeSettings& settings)
    : view_(view), origin_(origin), settings_(settings) {
  float from = 0, length = settings.first * spacing;
  for (unsigned i = 0; i < settings.cascades; ++i, from += length, length *= settings.ratio) {
    const bool last = i + 1 == settings.cascades;
    Cascade& cascade = cascades_.emplace_back();
    cascade.spacing = std::ldexp(spacing, static_cast<int>(i));
    cascade.side = settings.side << i;
    cascade.from = from, cascade.to = last ? kInfinity : from + length;
  }
  for (unsigned i = 0; i <= settings.cascades; ++i)
    directions_.push_back(healpix_directions(settings.side << i));
  for (std::size_t pixel = 0; pixel < pixels.size(); ++pixel) {
    if (!pixels[pixel]) continue;
    const glm::vec3 at = (view.hits()[pixel]->position - origin) / spacing - 0.5f;
    pixels_.emplace_back(pixel, cascades_[0].around(at));
  }
  for (std::size_t i = 0; i + 1 < cascades_.size(); ++i) {
    Cascade& next = cascades_[i + 1];
    for (const glm::ivec3& cell : cascades_[i].cells)
      cascades_[i].above.push_back(next.around(0.5f * glm::vec3(cell) - 0.25f));
  }
}

/// The probes of the next cascade around a probe, with weight 0 for those that it does not see.
Corners RadianceCascades::seen_from(const Cascade& cascade, std::size_t probe,
                                    const Cascade& next) const {
  Corners corners = cascade.above[probe];
  const glm::vec3 at = position(cascade, probe);
  for (int i = 0; i < 8; ++i) {
    if (view_.rays().occluded(at, position(next, corners.probe[i]) - at, 1)) corners.weight[i] = 0;
  }
  return corners;
}

/// Mean radiance of the finer directions in one direction, between probes, without rays that a
/// surface blocks before their interval. Empty if none is left.
std::optional<glm::vec3> RadianceCascades::merged(const Cascade& next, const Corners& corners,
                                                  std::size_t direction) const {
  glm::vec4 sum(0);
  for (int i = 0; i < 8; ++i) {
    if (corners.weight[i] == 0) continue;
    const glm::vec4* radiance = &next.radiance[corners.probe[i] * kFaces * next.side * next.side];
    for (unsigned c = 0; c < kChildren; ++c) {
      const glm::vec4& ray = radiance[healpix_child(direction, next.side / 2, c)];
      sum += corners.weight[i] * ray.w * glm::vec4(glm::vec3(ray), 1);
    }
  }
  return sum.w > 0 ? std::optional(glm::vec3(sum) / sum.w) : std::nullopt;
}

/// Traces a cascade's intervals and merges them with the next cascade, if there is one.
void RadianceCascades::trace(Cascade& cascade, const Cascade* next) {
  const std::vector<glm::vec3>& directions = directions_[&cascade - cascades_.data()];
  cascade.radiance.resize(cascade.cells.size() * directions.size());
  constexpr std::size_t kGrain = 4;
  view_.parallel_for(
      cascade.cells.size(), kGrain,
      [&](pathtracer::PathSampler& sampler, std::size_t first, std::size_t last) {
        for (std::size_t probe = first; probe < last; ++probe) {
          const glm::vec3 at = position(cascade, probe);
          const Corners corners = next ? seen_from(cascade, probe, *next) : Corners();
          for (std::size_t d = 0; d < directions.size(); ++d) {
            glm::vec4& radiance = cascade.radiance[probe * directions.size() + d];
            auto hit = view_.radiance(sampler, at, directions[d], cascade.to);
            if (!hit && next) {
              if (const auto far = merged(*next, corners, d)) {
                radiance = glm::vec4(*far, 1);
                continue;
              }
              hit = view_.radiance(sampler, at, directions[d], kInfinity);
            }
            radiance = glm::vec4(hit ? hit->radiance : view_.sky_radiance(directions[d]),
                                 !hit || hit->distance >= cascade.from ? 1 : 0);
          }
        }
      });
}

/// Irradiance at a pixel: cosine-weighted mean over the directions of the probes around it that see
/// it, or of rays from the pixel where none does.
glm::vec3 RadianceCascades::sample(pathtracer::PathSampler& sampler, std::size_t pixel,
                                   const Corners& corners) const {
  const Cascade& cascade = cascades_[0];
  const pathtracer::Hit& hit = *view_.hits()[pixel];
  const glm::vec3 from = view_.rays().offset_origin(hit);
  Corners used = corners;
  float total = 0;
  for (int i = 0; i < 8; ++i) {
    const glm::vec3 to = position(cascade, corners.probe[i]) - from;
    if (glm::dot(to, hit.normal) <= -kVisibleFrom * cascade.spacing ||
        view_.rays().occluded(from, to, 1))
      used.weight[i] = 0;
    total += used.weight[i];
  }
  glm::vec3 sum(0);
  float cosines = 0;
  const std::size_t count = directions_[0].size();
  for (std::size_t d = 0; d < count; ++d) {
    float cosine = 0;  // mean over the direction's solid angle
    for (unsigned c = 0; c < kChildren; ++c) {
      const glm::vec3& finer = directions_[1][healpix_child(d, settings_.side, c)];
      cosine += std::max(0.0f, glm::dot(finer, hit.normal));
    }
    if (cosine == 0) continue;
    cosines += cosine;
    if (total == 0) {
      const auto met = view_.radiance(sampler, from, directions_[0][d], kInfinity);
      sum += cosine * (met ? met->radiance : view_.sky_radiance(directions_[0][d]));
      continue;
    }
    for (int i = 0; i < 8; ++i) {
      const glm::vec4& radiance = cascade.radiance[used.probe[i] * count + d];
      sum += cosine * used.weight[i] / total * glm::vec3(radiance);
    }
  }
  return std::numbers::pi_v<float> * sum / cosines;
}

void RadianceCascades::render(Irradiance& image) {
  for (std::size_t i = cascades_.size(); i-- > 0;)
    trace(cascades_[i], i + 1 < cascades_.size() ? &cascades_[i + 1] : nullptr);
  view_.parallel_for(pixels_.size(), view_.width(),
                     [&](pathtracer::PathSampler& sampler, std::size_t first, std::size_t last) {
                       for (std::size_t i = first; i < last; ++i) {
                         const auto& [pixel, corners] = pixels_[i];
                         image.set(pixel, sample(sampler, pixel, corners));
                       }
                     });
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
        // A quarter of the ring's pixels.
        const int length = ring < n ? ring : ring > 3 * n ? 4 * n - ring : n;
        const double from_pole = double(length) * length / (3.0 * n * n);
        const double z = !cap       ? (2.0 * n - ring) * 2 / (3.0 * n)
                         : ring < n ? 1 - from_pole
                                    : from_pole - 1;
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

std::size_t healpix_child(std::size_t direction, unsigned side, unsigned which) {
  const std::size_t face = direction / (side * side), x = direction % side,
                    y = direction / side % side;
  return face * kChildren * side * side + (2 * y + (which >> 1)) * 2 * side + 2 * x + (which & 1);
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
    RadianceCascades cascades(view, origin, settings.spacing * grid.cell, pixels, settings);
    cascades.render(result.irradiance);
    result.bytes += cascades.bytes();
    result.probes += cascades.probes();
  }
  view.for_each_pixel([&](pathtracer::PathSampler&, std::size_t pixel) {
    if (!taken[pixel]) result.irradiance.set(pixel, glm::vec3(0));
  });
  return result;
}

}  // namespace clpv::baselines
