// SPDX-License-Identifier: MIT
// Quadrature that shares nothing with host/basis: product Gauss rules over the octants of a frame,
// and over a flat square seen from the origin. And the fixture of tests that every basis has to
// pass.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <glm/glm.hpp>
#include <memory>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "basis/basis.hpp"

namespace clpv::test {

struct Node {
  glm::dvec3 w;
  double weight;
};

/// Gauss-Legendre nodes and weights on [from, to].
inline std::vector<std::pair<double, double>> gauss(int n, double from, double to) {
  std::vector<std::pair<double, double>> rule;
  for (int i = 0; i < n; ++i) {
    double x = std::cos(std::numbers::pi * (i + 0.75) / (n + 0.5)), slope = 1;
    for (int k = 0; k < 50; ++k) {
      double p = 1, before = 0;
      for (int l = 1; l <= n; ++l)
        before = std::exchange(p, ((2 * l - 1) * x * p - (l - 1) * before) / l);
      slope = n * (before - x * p) / (1 - x * x);
      x -= p / slope;
    }
    rule.emplace_back(from + (to - from) * (1 + x) / 2,
                      (to - from) / ((1 - x * x) * slope * slope));
  }
  return rule;
}

/// Any two unit vectors across a unit z.
inline std::pair<glm::dvec3, glm::dvec3> across(const glm::dvec3& z) {
  const glm::dvec3 other = std::abs(z.x) < 0.5 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
  const glm::dvec3 x = glm::normalize(glm::cross(other, z));
  return {x, glm::cross(z, x)};
}

/// The sphere in eight octants of a frame with that z axis: exact to rounding for functions smooth
/// in each octant, such as max(0, w . z) times a basis function.
inline std::vector<Node> sphere(const glm::dvec3& z = {0, 0, 1}, int order = 24) {
  std::pair<glm::dvec3, glm::dvec3> frame{{1, 0, 0}, {0, 1, 0}};
  if (z != glm::dvec3(0, 0, 1)) frame = across(z);
  std::vector<Node> nodes;
  const auto rule = gauss(order, 0, std::numbers::pi / 2);
  for (int octant = 0; octant < 8; ++octant) {
    for (const auto& [angle, angle_weight] : rule) {
      for (const auto& [azimuth, azimuth_weight] : rule) {
        const double theta = angle + (octant & 1 ? std::numbers::pi / 2 : 0);
        const double phi = azimuth + (octant >> 1) * std::numbers::pi / 2;
        nodes.push_back(
            {std::sin(theta) * (std::cos(phi) * frame.first + std::sin(phi) * frame.second) +
                 std::cos(theta) * z,
             angle_weight * azimuth_weight * std::sin(theta)});
      }
    }
  }
  return nodes;
}

/// The unit square round `centre` across the unit `normal`, as directions seen from the origin.
inline std::vector<Node> square(const glm::dvec3& centre, const glm::dvec3& normal,
                                int order = 20) {
  const auto [u, v] = across(normal);
  std::vector<Node> nodes;
  for (const auto& [s, s_weight] : gauss(order, -0.5, 0.5)) {
    for (const auto& [t, t_weight] : gauss(order, -0.5, 0.5)) {
      const glm::dvec3 p = centre + s * u + t * v;
      const double distance = glm::length(p);
      nodes.push_back({p / distance, s_weight * t_weight * std::abs(glm::dot(p, normal)) /
                                         std::pow(distance, 3)});
    }
  }
  return nodes;
}

inline double integral(const std::vector<Node>& nodes,
                       const std::function<double(const glm::dvec3&)>& f) {
  double sum = 0;
  for (const Node& node : nodes) sum += node.weight * f(node.w);
  return sum;
}

/// Evenly spread axes: a Fibonacci spiral.
inline std::vector<glm::dvec3> spread_axes(int n) {
  std::vector<glm::dvec3> axes;
  for (int i = 0; i < n; ++i) {
    const double z = 1 - (2 * i + 1.0) / n, r = std::sqrt(1 - z * z);
    const double phi = 2 * std::numbers::pi * i / std::numbers::phi;
    axes.push_back(glm::normalize(glm::dvec3(r * std::cos(phi), r * std::sin(phi), z)));
  }
  return axes;
}

/// All but the direction bins: these jump, which quadrature over the whole sphere does not
/// integrate, and have up to 96 functions, which take long to compile. Tests of direction bins and
/// the check of propagation have them.
inline std::vector<std::string> smooth_bases() {
  std::vector<std::string> names = basis_names();
  std::erase_if(names, [](const std::string& name) { return name.starts_with("bins"); });
  return names;
}

struct EveryBasis : ::testing::TestWithParam<std::string> {
  const std::unique_ptr<Basis> basis_ = make_basis(GetParam());
};

}  // namespace clpv::test
