// SPDX-License-Identifier: MIT
// Counter-based random numbers and low-discrepancy points: a sample depends on its index and
// stream, not on the thread. Owen-scrambled Sobol points: Burley, 'Practical Hash-based Owen
// Scrambling' (JCGT 9(4), 2020).
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <glm/glm.hpp>
#include <numbers>
#include <span>
#include <vector>

namespace clpv {

/// 64-bit hash of `x` (the finaliser of SplitMix64).
constexpr std::uint64_t mix(std::uint64_t x) {
  x += 0x9e3779b97f4a7c15u;
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9u;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebu;
  return x ^ (x >> 31);
}

/// Substream `index` of a stream.
constexpr std::uint64_t mix(std::uint64_t stream, std::uint64_t index) {
  return mix(stream ^ mix(index));
}

/// Uniform number in [0, 1) from random bits.
constexpr double uniform(std::uint64_t bits) {
  return static_cast<double>(bits >> 11) * 0x1p-53;
}

constexpr std::uint32_t reverse_bits(std::uint32_t x) {
  x = ((x & 0x55555555u) << 1) | ((x >> 1) & 0x55555555u);
  x = ((x & 0x33333333u) << 2) | ((x >> 2) & 0x33333333u);
  x = ((x & 0x0f0f0f0fu) << 4) | ((x >> 4) & 0x0f0f0f0fu);
  x = ((x & 0x00ff00ffu) << 8) | ((x >> 8) & 0x00ff00ffu);
  return (x << 16) | (x >> 16);
}

/// Owen's nested uniform scramble by the Laine-Karras hash: the bits above a bit and the seed
/// decide whether it flips.
constexpr std::uint32_t owen_scramble(std::uint32_t x, std::uint32_t seed) {
  x = reverse_bits(x);
  x += seed;
  x ^= x * 0x6c50b47cu;
  x ^= x * 0xb82f1e52u;
  x ^= x * 0xc7afe638u;
  x ^= x * 0x8d22f6e6u;
  return reverse_bits(x);
}

/// Second dimension of the Sobol sequence; the first is reverse_bits.
constexpr std::uint32_t sobol_second(std::uint32_t index) {
  std::uint32_t result = 0;
  for (std::uint32_t direction = 1u << 31; index != 0; index >>= 1, direction ^= direction >> 1) {
    if (index & 1u) result ^= direction;
  }
  return result;
}

/// Point `index` of the scrambled and shuffled (0,2)-sequence of `stream`, in [0,1)^2. Sequences of
/// different streams are independent; each bounce of a path has one.
inline glm::dvec2 sobol_point(std::uint32_t index, std::uint64_t stream) {
  const std::uint64_t second = mix(stream);
  const std::uint32_t shuffled = owen_scramble(index, static_cast<std::uint32_t>(stream >> 32));
  const std::uint32_t x = owen_scramble(reverse_bits(shuffled), static_cast<std::uint32_t>(second));
  const std::uint32_t y =
      owen_scramble(sobol_second(shuffled), static_cast<std::uint32_t>(second >> 32));
  return {x * 0x1p-32, y * 0x1p-32};
}

/// Two unit vectors across a unit vector and each other, without a branch: Duff et al., 'Building
/// an Orthonormal Basis, Revisited' (JCGT 6(1), 2017).
inline std::array<glm::dvec3, 2> tangents_of(const glm::dvec3& normal) {
  const double sign = std::copysign(1.0, normal.z);
  const double a = -1.0 / (sign + normal.z), b = normal.x * normal.y * a;
  return {glm::dvec3{1.0 + sign * normal.x * normal.x * a, sign * b, -sign * normal.x},
          glm::dvec3{b, sign + normal.y * normal.y * a, -normal.y}};
}

/// Unit direction about `normal` with density cos / pi, by the concentric map of the square
/// (Shirley and Chiu, 'A Low Distortion Map Between Disk and Square', JGT 2(3), 1997).
inline glm::dvec3 cosine_direction(const glm::dvec3& normal, const glm::dvec2& point) {
  const glm::dvec2 square = 2.0 * point - 1.0;
  const bool wide = std::abs(square.x) > std::abs(square.y);
  const double radius = wide ? square.x : square.y;
  if (radius == 0.0) return normal;
  const double quarter = std::numbers::pi / 4;
  const double angle =
      wide ? quarter * square.y / square.x : 2 * quarter - quarter * square.x / square.y;
  const double up = std::sqrt(std::max(0.0, 1.0 - radius * radius));
  const auto [tangent, bitangent] = tangents_of(normal);
  return radius * std::cos(angle) * tangent + radius * std::sin(angle) * bitangent + up * normal;
}

/// Phase function of Henyey and Greenstein (1941) [1/sr]. `cosine`: between the directions of
/// travel before and after.
inline double phase(double g, double cosine) {
  const double d = 1 + g * g - 2 * g * cosine;
  return (1 - g * g) / (4 * std::numbers::pi * d * std::sqrt(d));
}

/// Unit direction with the density of Henyey and Greenstein's phase function about `along`, by
/// inversion of its cumulative distribution over the cosine.
inline glm::dvec3 phase_direction(const glm::dvec3& along, double g, const glm::dvec2& point) {
  const double u = 2 * point.x - 1;
  double cosine = u;
  if (std::abs(g) > 1e-3) {
    const double ratio = (1 - g * g) / (1 + g * u);
    cosine = std::clamp((1 + g * g - ratio * ratio) / (2 * g), -1.0, 1.0);
  }
  const double sine = std::sqrt(1 - cosine * cosine), angle = 2 * std::numbers::pi * point.y;
  const auto [tangent, bitangent] = tangents_of(along);
  return sine * std::cos(angle) * tangent + sine * std::sin(angle) * bitangent + cosine * along;
}

/// A stream of random numbers and directions.
struct Random {
  std::uint64_t state;
  double next() { return uniform(state = mix(state)); }
  glm::dvec3 direction() {
    const glm::dvec2 point(next(), next());
    return phase_direction(glm::dvec3(0, 0, 1), 0, point);
  }
};

/// A sampled interval of a discrete distribution.
struct CdfSample {
  std::size_t index;
  double fraction;  ///< position within the interval, in [0, 1]
};

/// Samples the distribution with cumulative probabilities `cdf` (rising to 1) by inversion of
/// `random` in [0, 1).
inline CdfSample sample_cdf(std::span<const double> cdf, double random) {
  const auto at = std::min(std::upper_bound(cdf.begin(), cdf.end(), random), cdf.end() - 1);
  const double before = at == cdf.begin() ? 0 : *(at - 1);
  return {static_cast<std::size_t>(at - cdf.begin()),
          *at > before ? std::clamp((random - before) / (*at - before), 0.0, 1.0) : 0.5};
}

// Directions of the rays of the near field (docs/method.md, 'Near field').

/// Unit directions about +z with density cos / pi: `rays` for each of the 4 x 4 pixels of a tile,
/// [4 y + x][ray]. All of a tile together, and those of each pixel, are (0,2)-nets. `rays` is a
/// power of two.
std::vector<std::vector<glm::vec3>> near_directions(int rays);

/// Width of a ray's cone over its length, for filtering textures: the rays of a tile share the
/// hemisphere.
double near_cone(int rays);

}  // namespace clpv
