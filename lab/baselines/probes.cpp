// SPDX-License-Identifier: MIT
// Baseline: irradiance probes. Numbers without a reason here are the paper's.
#include <atomic>
#include <cmath>
#include <limits>
#include <numbers>

#include "baselines/methods.hpp"
#include "basis/sampling.hpp"

namespace clpv::baselines {
namespace {

constexpr int kLightTexels = 8, kDistanceTexels = 16;  // along each edge of an octahedral map
constexpr int kDistancePower = 50;                     // power of the cosine that weights distances
constexpr float kHysteresis = 0.97f;   // share of earlier frames, once as many are blended
constexpr float kReach = 1.5f;         // distances count up to so many diagonals of a cell
constexpr float kBias = 0.3f * 0.75f;  // lift of a point before visibility [cells]
constexpr float kBehind = 0.2f;        // minimum weight of a probe by its direction
constexpr float kCrushed = 0.2f;       // smaller weights fall with their third power
constexpr std::uint64_t kSeed = 3;

/// Unit vector at a point of [-1, 1]^2 (Cigolle et al., 'A Survey of Efficient Representations for
/// Independent Unit Vectors', JCGT 3(2), 2014).
glm::vec3 octahedral_direction(glm::vec2 at) {
  glm::vec3 v(at.x, at.y, 1 - std::abs(at.x) - std::abs(at.y));
  if (v.z < 0) {
    v = {(1 - std::abs(at.y)) * std::copysign(1.0f, at.x),
         (1 - std::abs(at.x)) * std::copysign(1.0f, at.y), v.z};
  }
  return glm::normalize(v);
}

glm::vec2 octahedral_point(const glm::vec3& v) {
  const glm::vec2 at = glm::vec2(v) / (std::abs(v.x) + std::abs(v.y) + std::abs(v.z));
  if (v.z >= 0) return at;
  return {(1 - std::abs(at.y)) * std::copysign(1.0f, at.x),
          (1 - std::abs(at.x)) * std::copysign(1.0f, at.y)};
}

/// Index of a texel of a map with `edge` texels along each edge, from -1 to `edge`: coordinates
/// beyond an edge are mirrored.
std::size_t folded(int x, int y, int edge) {
  if (x < 0 || x >= edge) x = std::clamp(x, 0, edge - 1), y = edge - 1 - y;
  if (y < 0 || y >= edge) y = std::clamp(y, 0, edge - 1), x = edge - 1 - x;
  return static_cast<std::size_t>(y) * edge + x;
}

/// Texels around a direction and their bilinear weights.
struct Texels {
  std::size_t index[4];
  float weight[4];

  template <typename T>
  T mean(const T* map) const {
    return weight[0] * map[index[0]] + weight[1] * map[index[1]] + weight[2] * map[index[2]] +
           weight[3] * map[index[3]];
  }
};

Texels texels_about(const glm::vec3& direction, int edge) {
  const glm::vec2 at = (octahedral_point(direction) + 1.0f) * 0.5f * float(edge) - 0.5f,
                  low = glm::floor(at), f = at - low;
  const int x = static_cast<int>(low.x), y = static_cast<int>(low.y);
  return {{folded(x, y, edge), folded(x + 1, y, edge), folded(x, y + 1, edge),
           folded(x + 1, y + 1, edge)},
          {(1 - f.x) * (1 - f.y), f.x * (1 - f.y), (1 - f.x) * f.y, f.x * f.y}};
}

/// `count` directions of a spherical Fibonacci set, in a random rotation of each frame.
std::vector<glm::vec3> ray_directions(unsigned count, unsigned frame) {
  const auto random = [&](std::uint64_t i) { return uniform(mix(mix(kSeed, frame), i)); };
  const double up = 1 - 2 * random(0), round = 2 * std::numbers::pi * random(1),
               across = std::sqrt(1 - up * up);
  const glm::dvec3 axis(across * std::cos(round), across * std::sin(round), up);
  const auto [u, v] = tangents_of(axis);
  const double start = random(2), golden = std::numbers::phi - 1;
  std::vector<glm::vec3> directions;
  for (unsigned i = 0; i < count; ++i) {
    const double z = 1 - (2 * i + 1.0) / count, r = std::sqrt(1 - z * z),
                 angle = 2 * std::numbers::pi * (start + i * golden);
    directions.emplace_back(r * std::cos(angle) * u + r * std::sin(angle) * v + z * axis);
  }
  return directions;
}

/// Weights of all rays for each texel, which sum to 1, or are all 0 where no ray counts.
std::vector<float> texel_weights(const std::vector<glm::vec3>& directions, int edge, int power) {
  std::vector<float> weights;
  for (int texel = 0; texel < edge * edge; ++texel) {
    const glm::vec2 at = 2.0f * (glm::vec2(texel % edge, texel / edge) + 0.5f) / float(edge) - 1.0f;
    const glm::vec3 axis = octahedral_direction(at);
    const std::size_t first = weights.size();
    float sum = 0;
    for (const glm::vec3& direction : directions) {
      weights.push_back(std::pow(std::max(0.0f, glm::dot(axis, direction)), float(power)));
      sum += weights.back();
    }
    for (std::size_t i = first; sum > 0 && i < weights.size(); ++i) weights[i] /= sum;
  }
  return weights;
}

/// Blends the weighted means of a probe's rays into its map. Texels that no ray counts for keep
/// their value.
template <typename T>
void blend(T* map, const std::vector<float>& weights, const std::vector<T>& rays, float share) {
  for (std::size_t texel = 0; texel * rays.size() < weights.size(); ++texel) {
    const float* weight = &weights[texel * rays.size()];
    T mean(0);
    float sum = 0;
    for (std::size_t ray = 0; ray < rays.size(); ++ray)
      mean += weight[ray] * rays[ray], sum += weight[ray];
    if (sum > 0) map[texel] += share * (mean - map[texel]);
  }
}

glm::vec3 origin_of(const ClpvGrid& grid) {
  return {grid.origin[0], grid.origin[1], grid.origin[2]};
}

}  // namespace

/// Finds the probe cubes that contain pixels, and numbers their corners. Probes lie at the cells'
/// centres. Keeps results of earlier frames if the numbers do not change (static camera).
void Probes::find_probes() {
  corners_.resize(view_.hits().size());
  // The cubes by their first cell, by grid; threads write the same value.
  std::vector<std::vector<char>> used;
  for (const ClpvGrid& grid : grids_) used.emplace_back(std::size_t{grid.n} * grid.n * grid.n, 0);
  view_.for_each_pixel([&](pathtracer::PathSampler&, std::size_t pixel) {
    corners_[pixel] = {};
    for (std::size_t g = 0; g < grids_.size(); ++g) {
      const ClpvGrid& grid = grids_[g];
      const glm::vec3 at = (view_.hits()[pixel]->position - origin_of(grid)) / grid.cell - 0.5f,
                      low = glm::floor(at);
      const auto last = static_cast<float>(grid.n - 1);
      if (glm::any(glm::lessThan(low, glm::vec3(0))) ||
          glm::any(glm::greaterThanEqual(low, glm::vec3(last))))
        continue;
      const glm::uvec3 cell(low);
      corners_[pixel] = {cell.x + grid.n * (cell.y + grid.n * cell.z), at - low,
                         static_cast<int>(g)};
      std::atomic_ref(used[g][corners_[pixel].first]).store(1, std::memory_order_relaxed);
      break;
    }
  });
  std::vector<glm::vec3> positions;
  limits_.clear();
  slots_.resize(grids_.size());
  for (std::size_t g = 0; g < grids_.size(); ++g) {
    const ClpvGrid& grid = grids_[g];
    slots_[g].assign(used[g].size(), -1);
    for (std::uint32_t first = 0; first < used[g].size(); ++first) {
      if (!used[g][first]) continue;
      for (unsigned corner = 0; corner < 8; ++corner) {
        const std::uint32_t cell =
            first + (corner & 1) + grid.n * ((corner >> 1 & 1) + grid.n * (corner >> 2));
        if (slots_[g][cell] >= 0) continue;
        slots_[g][cell] = static_cast<std::int32_t>(positions.size());
        const glm::vec3 at(cell % grid.n, cell / grid.n % grid.n, cell / grid.n / grid.n);
        positions.push_back(origin_of(grid) + (at + 0.5f) * grid.cell);
        limits_.push_back(kReach * std::sqrt(3.0f) * grid.cell);
      }
    }
  }
  if (positions == positions_) return;
  positions_ = std::move(positions);
  frame_ = 0;
  radiance_.assign(positions_.size() * kLightTexels * kLightTexels, glm::vec3(0));
  distance_.assign(positions_.size() * kDistanceTexels * kDistanceTexels, glm::vec2(0));
}

void Probes::trace(unsigned rays) {
  const std::vector<glm::vec3> directions = ray_directions(rays, frame_);
  const std::vector<float> light_weights = texel_weights(directions, kLightTexels, 1),
                           distance_weights =
                               texel_weights(directions, kDistanceTexels, kDistancePower);
  const float share = std::max(1 / (frame_ + 1.0f), 1 - kHysteresis);
  constexpr std::size_t kGrain = 8;
  view_.parallel_for(
      positions_.size(), kGrain,
      [&](pathtracer::PathSampler& sampler, std::size_t first, std::size_t last) {
        std::vector<glm::vec3> radiance(rays);
        std::vector<glm::vec2> distance(rays);
        for (std::size_t probe = first; probe < last; ++probe) {
          for (unsigned i = 0; i < rays; ++i) {
            const auto hit = view_.radiance(sampler, positions_[probe], directions[i],
                                            std::numeric_limits<float>::infinity());
            const float length = hit ? std::min(hit->distance, limits_[probe]) : limits_[probe];
            distance[i] = {length, length * length};
            radiance[i] = hit ? hit->radiance : view_.sky_radiance(directions[i]);
          }
          blend(&radiance_[probe * kLightTexels * kLightTexels], light_weights, radiance, share);
          blend(&distance_[probe * kDistanceTexels * kDistanceTexels], distance_weights, distance,
                share);
        }
      });
}

/// Irradiance at a pixel: mean of the eight surrounding probes, weighted trilinearly, by direction
/// and by visibility.
glm::vec3 Probes::sample(std::size_t pixel) const {
  const Corner& corner = corners_[pixel];
  if (corner.grid < 0) return glm::vec3(0);
  const ClpvGrid& grid = grids_[corner.grid];
  const pathtracer::Hit& hit = *view_.hits()[pixel];
  const glm::vec3 lifted =
      hit.position +
      kBias * grid.cell * (0.2f * hit.normal + 0.8f * glm::normalize(view_.eye() - hit.position));
  const Texels along_normal = texels_about(hit.normal, kLightTexels);
  glm::vec4 sum(0);
  for (unsigned i = 0; i < 8; ++i) {
    const glm::uvec3 offset(i & 1, i >> 1 & 1, i >> 2);
    const std::int32_t probe =
        slots_[corner.grid][corner.first + offset.x + grid.n * (offset.y + grid.n * offset.z)];
    const glm::vec3 f = glm::mix(1.0f - corner.fraction, corner.fraction, glm::vec3(offset));
    const glm::vec3 to_probe = positions_[probe] - hit.position;
    // A probe may lie on the surface.
    const float distance = std::max(glm::length(to_probe), 1e-6f * grid.cell);
    const float facing = 0.5f * (glm::dot(to_probe, hit.normal) / distance + 1);
    float weight = facing * facing + kBehind;
    const glm::vec3 from_probe = lifted - positions_[probe];
    const float away = glm::length(from_probe);
    if (away > 0) {
      const glm::vec2 moments = texels_about(from_probe, kDistanceTexels)
                                    .mean(&distance_[probe * kDistanceTexels * kDistanceTexels]);
      const float beyond = away - moments.x;
      if (beyond > 0) {  // Chebyshev's bound of the share of distances above `away`
        const float variance = std::abs(moments.y - moments.x * moments.x),
                    bound = variance / (variance + beyond * beyond);
        weight *= bound * bound * bound;
      }
    }
    weight = std::max(weight, 1e-6f);  // defines the mean of pixels that no probe sees
    if (weight < kCrushed) weight *= weight * weight / (kCrushed * kCrushed);
    weight *= std::max(0.001f, f.x * f.y * f.z);
    sum +=
        weight * glm::vec4(along_normal.mean(&radiance_[probe * kLightTexels * kLightTexels]), 1);
  }
  return std::numbers::pi_v<float> * glm::vec3(sum) / sum.w;
}

Irradiance Probes::render(unsigned rays) {
  find_probes();
  trace(rays);
  ++frame_;
  Irradiance image(view_.hits().size());
  view_.for_each_pixel(
      [&](pathtracer::PathSampler&, std::size_t pixel) { image.set(pixel, sample(pixel)); });
  return image;
}

}  // namespace clpv::baselines
