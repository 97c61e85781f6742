// SPDX-License-Identifier: MIT
#include "basis/lobe_quality.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <vector>

namespace clpv {
namespace {

using std::numbers::pi;
constexpr double kCosineNorm = 2 * pi / 3;  // Int max(0, w . d)^2 dw
constexpr int kEvenDirections = 2000;       // give means to three digits
constexpr double kSpacing = pi / 90;        // between start points: finer than any lobe's features
constexpr double kResolution = 1e-7;        // [rad] of the maximum's direction

// Unit direction of f's maximum: the best of a grid of directions, refined by pattern search with
// shrinking steps.
glm::dvec3 argmax(const std::function<double(const glm::dvec3&)>& f) {
  glm::dvec3 best(0, 0, 1);
  double value = f(best);
  const auto improve = [&](const glm::dvec3& w) {
    const double candidate = f(w);
    if (!(candidate > value)) return false;
    value = candidate;
    best = w;
    return true;
  };
  for (double theta = kSpacing / 2; theta < pi; theta += kSpacing) {
    for (double phi = 0; phi < 2 * pi; phi += kSpacing) {
      improve({std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)});
    }
  }
  for (double step = kSpacing; step > kResolution;) {
    bool moved = false;
    for (const glm::ivec3& axis : kAxes)
      moved |= improve(glm::normalize(best + step * glm::dvec3(axis)));
    if (!moved) step /= 2;
  }
  return best;
}

}  // namespace

double relative_l2(const Basis& basis, std::span<const double> c, const glm::dvec3& d) {
  std::vector<double> alpha(c.size());
  basis.cosine_integrals(d, alpha);
  return std::sqrt(std::max(0.0, kCosineNorm + dot(c, basis.gram() * c) - 2 * dot(c, alpha)) /
                   kCosineNorm);
}

std::vector<glm::dvec3> even_directions(int count) {
  std::vector<glm::dvec3> directions;
  for (int i = 0; i < count; ++i) {
    const double z = 1 - (2 * i + 1.0) / count, radius = std::sqrt(1 - z * z);
    const double azimuth = pi * (3 - std::sqrt(5.0)) * i;
    directions.emplace_back(radius * std::cos(azimuth), radius * std::sin(azimuth), z);
  }
  return directions;
}

LobeQuality lobe_quality(const Basis& basis, std::span<const double> c, const glm::dvec3& d) {
  std::vector<double> b(c.size());
  const auto value = [&](const glm::dvec3& w) {
    basis.evaluate(w, b);
    return dot(c, b);
  };
  const glm::dvec3 peak = argmax(value),
                   minimum = argmax([&](const glm::dvec3&w) { return -value(w); });
  return {relative_l2(basis, c, d), value(minimum), basis.energy(c),
          std::atan2(glm::length(glm::cross(peak, d)), glm::dot(peak, d)) * 180 / pi};
}

double mean_relative_l2(const Basis& basis, const Lobes& lobes) {
  double sum = 0;
  for (const glm::dvec3& d : even_directions(kEvenDirections))
    sum += relative_l2(basis, lobes(d), d);
  return sum / kEvenDirections;
}

double energy_after(const Basis& basis, const FaceTransport& transport, int steps) {
  std::vector<double> c = basis.constant();
  const double before = basis.energy(c);
  for (int step = 0; step < steps; ++step) {
    std::vector<double> through(kAxes.size(), 0.0);
    for (const Face& face : transport.faces) {
      const auto axis = std::find(kAxes.begin(), kAxes.end(), face.normal) - kAxes.begin();
      through[axis] += dot(face.flux, c);
    }
    c = transport.lobes * through;
  }
  return basis.energy(c) / before;
}

}  // namespace clpv
