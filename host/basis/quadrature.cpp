// SPDX-License-Identifier: MIT
#include "basis/quadrature.hpp"

#include <array>
#include <cmath>
#include <numbers>

#include "support/error.hpp"

namespace clpv {
namespace {

constexpr int kOrder = 12;                // Gauss points along each side of a triangle
constexpr double kRelativeError = 4e-15;  // relative to a test function's integral over the sphere
// Bisections of a triangle's edges: resolves peaks 1e-4 rad wide.
constexpr int kMaxRefinements = 14;
constexpr double kOnPlane = 1e-12;  // a corner closer than this lies on a plane

using Triangle = std::array<glm::dvec3, 3>;

// Gauss-Legendre nodes and weights on [0, 1], by Newton's method on P_n.
struct GaussRule {
  std::array<double, kOrder> x, weight;
};

GaussRule gauss_rule() {
  GaussRule rule{};
  for (int i = 0; i < kOrder; ++i) {
    double x = std::cos(std::numbers::pi * (i + 0.75) / (kOrder + 0.5)), slope = 1;
    for (int iteration = 0; iteration < 20; ++iteration) {
      double before = 1, now = x;
      for (int n = 2; n <= kOrder; ++n) {
        const double next = ((2 * n - 1) * x * now - (n - 1) * before) / n;
        before = now;
        now = next;
      }
      slope = kOrder * (x * now - before) / (x * x - 1);
      x -= now / slope;
    }
    rule.x[i] = (1 - x) / 2;
    rule.weight[i] = 1 / ((1 - x * x) * slope * slope);
  }
  return rule;
}

// Collapsed product rule on the flat triangle, projected onto the sphere: dw = (a . n) / |p|^3 dA.
std::vector<QuadratureNode> triangle_nodes(const Triangle& t) {
  static const GaussRule rule = gauss_rule();
  const double volume = std::abs(glm::dot(t[0], glm::cross(t[1], t[2])));
  std::vector<QuadratureNode> nodes;
  for (std::size_t i = 0; i < kOrder; ++i) {
    for (std::size_t j = 0; j < kOrder; ++j) {
      const double u = rule.x[i], v = rule.x[j];
      const glm::dvec3 p = t[0] + u * ((1 - v) * (t[1] - t[0]) + v * (t[2] - t[0]));
      const double length = glm::length(p);
      nodes.push_back(
          {p / length, volume * u * rule.weight[i] * rule.weight[j] / (length * length * length)});
    }
  }
  return nodes;
}

// Integrals of the test functions: b_i, b_i^2 and 1 / |w|_1.
std::vector<double> probe(const Basis& basis, const std::vector<QuadratureNode>& nodes) {
  const std::size_t n = basis.size();
  std::vector<double> sums(2 * n + 1, 0.0), b(n);
  for (const QuadratureNode& node : nodes) {
    basis.evaluate(node.w, b);
    for (std::size_t i = 0; i < n; ++i) {
      sums[i] += node.weight * b[i];
      sums[n + i] += node.weight * b[i] * b[i];
    }
    sums[2 * n] += node.weight / (std::abs(node.w.x) + std::abs(node.w.y) + std::abs(node.w.z));
  }
  return sums;
}

// Adaptive subdivision of triangles until integrals of the test functions agree.
class Refinement {
 public:
  explicit Refinement(const Basis& basis) : basis_(basis) {}

  void add(const Triangle& t) { refine(t, triangle_nodes(t), kMaxRefinements); }
  std::vector<QuadratureNode> take() { return std::move(nodes_); }

 private:
  void refine(const Triangle& t, const std::vector<QuadratureNode>& nodes, int left) {
    const glm::dvec3 ab = glm::normalize(t[0] + t[1]), bc = glm::normalize(t[1] + t[2]),
                     ca = glm::normalize(t[2] + t[0]);
    const std::array<Triangle, 4> children{
        Triangle{t[0], ab, ca}, {t[1], bc, ab}, {t[2], ca, bc}, {ab, bc, ca}};
    std::array<std::vector<QuadratureNode>, 4> finer;
    const std::vector<double> coarse = probe(basis_, nodes);
    std::vector<double> fine(coarse.size(), 0.0);
    for (std::size_t i = 0; i < children.size(); ++i) {
      finer[i] = triangle_nodes(children[i]);
      const std::vector<double> integrals = probe(basis_, finer[i]);
      for (std::size_t k = 0; k < fine.size(); ++k) fine[k] += integrals[k];
    }
    if (agree(coarse, fine)) {
      nodes_.insert(nodes_.end(), nodes.begin(), nodes.end());
      return;
    }
    if (left == 0)
      throw Error(ExitCode::usage,
                  "lambda: found {} with basis {}, too peaked to integrate; allowed: a smaller one",
                  basis_.lambda_text(), basis_.name());
    for (std::size_t i = 0; i < children.size(); ++i) refine(children[i], finer[i], left - 1);
  }

  bool agree(const std::vector<double>& coarse, const std::vector<double>& fine) const {
    const std::size_t n = basis_.size();
    for (std::size_t i = 0; i < coarse.size(); ++i) {
      const double size = i < 2 * n
                              ? basis_.gram()(static_cast<int>(i % n), static_cast<int>(i % n))
                              : 4 * std::numbers::pi;
      if (!(std::abs(coarse[i] - fine[i]) <= kRelativeError * size)) return false;
    }
    return true;
  }

  const Basis& basis_;
  std::vector<QuadratureNode> nodes_;
};

// Clips a polygon to the half-space that `normal` points into.
SphericalPolygon clipped(const SphericalPolygon& polygon, const glm::dvec3& normal) {
  SphericalPolygon kept;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const glm::dvec3 &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
    const double da = glm::dot(a, normal), db = glm::dot(b, normal);
    if (da >= -kOnPlane) kept.push_back(a);
    if ((da > kOnPlane && db < -kOnPlane) || (da < -kOnPlane && db > kOnPlane)) {
      kept.push_back(glm::normalize(std::abs(db) * a + std::abs(da) * b));
    }
  }
  return kept;
}

bool reaches(const SphericalPolygon& polygon, const glm::dvec3& normal) {
  for (const glm::dvec3& corner : polygon) {
    if (glm::dot(corner, normal) > kOnPlane) return true;
  }
  return false;
}

}  // namespace

std::vector<SphericalPolygon> octants() {
  std::vector<SphericalPolygon> result;
  for (const double z : {1.0, -1.0}) {
    for (const double y : {1.0, -1.0}) {
      for (const double x : {1.0, -1.0}) result.push_back({{x, 0, 0}, {0, y, 0}, {0, 0, z}});
    }
  }
  return result;
}

std::vector<SphericalPolygon> split(std::vector<SphericalPolygon> polygons,
                                    std::span<const glm::dvec3> planes) {
  for (const glm::dvec3& normal : planes) {
    std::vector<SphericalPolygon> next;
    for (const SphericalPolygon& polygon : polygons) {
      for (const glm::dvec3& side : {normal, -normal}) {
        if (reaches(polygon, side)) next.push_back(clipped(polygon, side));
      }
    }
    polygons = std::move(next);
  }
  return polygons;
}

std::vector<QuadratureNode> nodes_of(const SphericalPolygon& polygon) {
  std::vector<QuadratureNode> nodes;
  for (std::size_t i = 1; i + 1 < polygon.size(); ++i) {
    const std::vector<QuadratureNode> more =
        triangle_nodes(Triangle{polygon[0], polygon[i], polygon[i + 1]});
    nodes.insert(nodes.end(), more.begin(), more.end());
  }
  return nodes;
}

double solid_angle(const SphericalPolygon& polygon) {
  // tan(Omega / 2) = |a . (b x c)| / (1 + a . b + b . c + c . a) for each triangle of a fan.
  double sum = 0;
  for (std::size_t i = 1; i + 1 < polygon.size(); ++i) {
    const glm::dvec3 &a = polygon[0], &b = polygon[i], &c = polygon[i + 1];
    sum += 2 * std::atan2(std::abs(glm::dot(a, glm::cross(b, c))),
                          1 + glm::dot(a, b) + glm::dot(b, c) + glm::dot(c, a));
  }
  return sum;
}

std::vector<QuadratureNode> quadrature(const Basis& basis,
                                       const std::vector<SphericalPolygon>& polygons) {
  Refinement refinement(basis);
  std::vector<glm::dvec3> planes = basis.creases();
  planes.insert(planes.end(), {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}});  // kinks of |w|_1
  for (const SphericalPolygon& polygon : split(polygons, planes)) {
    for (std::size_t i = 1; i + 1 < polygon.size(); ++i)
      refinement.add({polygon[0], polygon[i], polygon[i + 1]});
  }
  return refinement.take();
}

}  // namespace clpv
