// SPDX-License-Identifier: MIT
#include "basis/direction_bins.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "basis/transport.hpp"
#include "support/text.hpp"

namespace clpv {
namespace {

// Boundary between the inner and outer bins of a face of bins96. Equal angles minimise the mean
// lobe error.
const double kLine = std::tan(std::numbers::pi / 8);
constexpr int kPatchesAlongFace = 4;

// Heaviside step: 1 for s > 0, 0 for s < 0, 1/2 on the boundary.
double step(double s) {
  return s > 0 ? 1 : (s < 0 ? 0 : 0.5);
}

std::vector<double> inner_lines(int side) {
  return side == 2 ? std::vector<double>{0} : std::vector<double>{-kLine, 0, kLine};
}

}  // namespace

DirectionBins::DirectionBins(int side) : side_(side), lines_(inner_lines(side)) {
  size_ = 6 * side * side;
  name_ = fmt::format("bins{}", size_);
  std::vector<double> corners = inner_lines(kPatchesAlongFace);
  corners.insert(corners.begin(), -1);
  corners.push_back(1);
  const int patches_per_bin = kPatchesAlongFace / side;
  std::vector<double> solid_angles(size_, 0.0);
  for (int face = 0; face < 6; ++face) {
    for (std::size_t v = 0; v < kPatchesAlongFace; ++v) {
      for (std::size_t u = 0; u < kPatchesAlongFace; ++u) {
        const SphericalPolygon polygon =
            face_region(face, {corners[u], corners[u + 1]}, {corners[v], corners[v + 1]});
        const int bin = (face * side + static_cast<int>(v) / patches_per_bin) * side +
                        static_cast<int>(u) / patches_per_bin;
        solid_angles[bin] += solid_angle(polygon);
        add_patch(bin, polygon);
      }
    }
  }
  Matrix gram(size_, size_);
  for (int i = 0; i < size_; ++i) gram(i, i) = solid_angles[i];
  set_gram(std::move(gram), std::move(solid_angles));
}

FaceAxes axes_of(int face) {
  const int n = face / 2;
  return {n, (n + 1) % 3, (n + 2) % 3, face % 2 == 0 ? 1.0 : -1.0};
}

SphericalPolygon face_region(int face, std::array<double, 2> u, std::array<double, 2> v) {
  const FaceAxes axes = axes_of(face);
  SphericalPolygon corners;
  for (const auto& [i, j] : {std::pair<std::size_t, std::size_t>{0, 0}, {1, 0}, {1, 1}, {0, 1}}) {
    glm::dvec3 corner;
    corner[axes.n] = axes.sign;
    corner[axes.u] = u[i];
    corner[axes.v] = v[j];
    corners.push_back(glm::normalize(corner));
  }
  return corners;
}

void DirectionBins::add_patch(int bin, const SphericalPolygon& polygon) {
  double total = 0;
  glm::dvec3 area(0);
  for (const QuadratureNode& node : nodes_of(polygon)) {
    total += node.weight;
    area += node.weight * node.w;
  }
  // Variance along one axis: half the mean square distance from the patch's middle. A uniform
  // distribution of that variance has a width of sqrt(12 variance).
  const glm::dvec3 middle = glm::normalize(area);
  double across = 0;
  for (const QuadratureNode& node : nodes_of(polygon)) {
    across += node.weight * (1 - glm::dot(node.w, middle) * glm::dot(node.w, middle));
  }
  patches_.push_back({bin, area, std::sqrt(12 * across / (2 * total)) * total});
}

std::vector<glm::dvec3> DirectionBins::creases() const {
  std::vector<glm::dvec3> planes;
  const double half = std::sqrt(0.5);
  for (const glm::dvec3& edge :
       {glm::dvec3(1, 1, 0), {1, -1, 0}, {0, 1, 1}, {0, 1, -1}, {1, 0, 1}, {-1, 0, 1}}) {
    planes.push_back(half * edge);
  }
  for (int n = 0; n < 3; ++n) {
    for (int t = 1; t < 3; ++t) {
      for (const double line : lines_) {
        glm::dvec3 plane(0);
        plane[(n + t) % 3] = 1;
        plane[n] = -line;
        planes.push_back(glm::normalize(plane));
      }
    }
  }
  return planes;
}

void DirectionBins::evaluate(const glm::dvec3& w, std::span<double> b) const {
  const std::size_t side = side_;
  const auto share = [&](double t, double n, std::size_t i) {
    const double above = i == 0 ? 1 : step(t - lines_[i - 1] * n);
    return above - (i + 1 == side ? 0 : step(t - lines_[i] * n));
  };
  std::array<double, 6> of_face{};
  double sum = 0;  // 1, or 3/4 in a corner of the cube
  for (int face = 0; face < 6; ++face) {
    const FaceAxes axes = axes_of(face);
    const double n = axes.sign * w[axes.n];
    sum += of_face[face] = step(n - std::abs(w[axes.u])) * step(n - std::abs(w[axes.v]));
  }
  for (int face = 0; face < 6; ++face) {
    const FaceAxes axes = axes_of(face);
    const double n = axes.sign * w[axes.n];
    for (std::size_t i = 0; i < side * side; ++i) {
      b[static_cast<std::size_t>(face) * side * side + i] =
          of_face[face] / sum * share(w[axes.u], n, i % side) * share(w[axes.v], n, i / side);
    }
  }
}

void DirectionBins::cosine_integrals(const glm::dvec3& d, std::span<double> alpha) const {
  std::ranges::fill(alpha, 0.0);
  double sum = 0;
  for (const Patch& patch : patches_) {
    const double t = glm::dot(patch.area, d);
    const double above = std::clamp(t / patch.width + 0.5, 0.0, 1.0);  // share above the horizon
    const double integral =
        0.5 * patch.width * above * above + std::max(0.0, t - 0.5 * patch.width);
    alpha[patch.bin] += integral;
    sum += integral;
  }
  for (double& value : alpha) value *= std::numbers::pi / sum;
}

std::string DirectionBins::kernel_basis() const {
  static const char* const kNames[] = {"x", "y", "z"};
  std::string text =
      "static inline float unit_step(const float s) { return fma(0.5f, sign(s), 0.5f); }\n"
      "static inline Coefficients basis_functions(const float x, const float y, const float z) {\n "
      " Coefficients r;\n";
  std::string sum;
  for (int face = 0; face < 6; ++face) {
    const FaceAxes axes = axes_of(face);
    const std::string n = fmt::format("n{}", face);
    text += fmt::format("  const float {} = {}{};\n", n, axes.sign < 0 ? "-" : "", kNames[axes.n]);
    text += fmt::format(
        "  const float f{0} = unit_step({1} - fabs({2})) * unit_step({1} - fabs({3}));\n", face, n,
        kNames[axes.u], kNames[axes.v]);
    sum += fmt::format("{}f{}", face == 0 ? "" : " + ", face);
  }
  text += fmt::format("  const float whole = 1.0f / ({});\n", sum);
  for (int face = 0; face < 6; ++face) {
    const FaceAxes axes = axes_of(face);
    for (const auto& [letter, axis] : {std::pair{'u', axes.u}, {'v', axes.v}}) {
      for (int i = 0; i + 1 < side_; ++i) {
        text += fmt::format("  const float {}{}_{} = unit_step(fma({}, n{}, {}));\n", letter, face,
                            i, float_literal(-lines_[i]), face, kNames[axis]);
      }
    }
    const auto share = [&](char letter, int i) {
      const std::string above = i == 0 ? "1.0f" : fmt::format("{}{}_{}", letter, face, i - 1);
      return i + 1 == side_ ? above : fmt::format("({} - {}{}_{})", above, letter, face, i);
    };
    for (int i = 0; i < side_ * side_; ++i) {
      text += fmt::format("  r.c[{}] = f{} * whole * {} * {};\n", face * side_ * side_ + i, face,
                          share('u', i % side_), share('v', i / side_));
    }
  }
  return text + "  return r;\n}\n";
}

// Evaluates one patch of each of 8 bins at a time: scalar code would take most of injection's time.
std::string DirectionBins::kernel_cosine() const {
  constexpr int kLanes = 8;
  std::vector<std::vector<Patch>> of_bin(size_);
  for (const Patch& patch : patches_) of_bin[patch.bin].push_back(patch);
  std::string text =
      "static inline Coefficients cosine_integrals(const float x, const float y, const float z) {\n"
      "  const float8 none = (float8)(0.0f), whole = (float8)(1.0f);\n  float8 t, lit;\n";
  std::string all;
  for (int first = 0; first < size_; first += kLanes) {
    text += fmt::format("  float8 part{} = none;\n", first / kLanes);
    all += fmt::format("{}part{}", first == 0 ? "" : " + ", first / kLanes);
  }
  for (std::size_t turn = 0; turn < of_bin.front().size(); ++turn) {
    for (int first = 0; first < size_; first += kLanes) {
      const auto lanes = [&](auto value) {
        std::string numbers;
        for (int lane = 0; lane < kLanes; ++lane) {
          const Patch& patch = of_bin[first + lane][turn];
          numbers += fmt::format("{}{}", lane == 0 ? "" : ", ", float_literal(value(patch)));
        }
        return "(float8)(" + numbers + ")";
      };
      const std::string half = lanes([](const Patch& p) { return 0.5 * p.width; });
      text += fmt::format("  t = {} * x + {} * y + {} * z;\n",
                          lanes([](const Patch& p) { return p.area.x; }),
                          lanes([](const Patch& p) { return p.area.y; }),
                          lanes([](const Patch& p) { return p.area.z; }));
      text += fmt::format("  lit = clamp(t * {} + 0.5f, none, whole);\n",
                          lanes([](const Patch& p) { return 1 / p.width; }));
      text += fmt::format("  part{0} += {1} * lit * lit + fmax(none, t - {1});\n", first / kLanes,
                          half);
    }
  }
  text +=
      fmt::format("  const float8 all = {};\n  const float4 half_all = all.lo + all.hi;\n", all);
  text += fmt::format(
      "  const float scale = {} / (half_all.x + half_all.y + half_all.z + half_all.w);\n  "
      "Coefficients r;\n",
      float_literal(std::numbers::pi));
  for (int i = 0; i < size_; ++i)
    text += fmt::format("  r.c[{}] = part{}.s{} * scale;\n", i, i / kLanes, i % kLanes);
  return text + "  return r;\n}\n";
}

std::string DirectionBins::kernel_source() const {
  return kernel_basis() + kernel_cosine();
}

}  // namespace clpv
