// SPDX-License-Identifier: MIT
#include "basis/direction_bins.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "basis/transport.hpp"

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

void DirectionBins::add_literals(Literals& literals) const {
  std::vector<int> placed(size_, 0);  // patches of each bin so far
  const int patches = static_cast<int>(patches_.size()) / size_;
  Matrix x(patches, size_), y = x, z = x, width = x, per_width = x;
  for (const Patch& patch : patches_) {
    const int row = placed[patch.bin]++;
    x(row, patch.bin) = patch.area.x;
    y(row, patch.bin) = patch.area.y;
    z(row, patch.bin) = patch.area.z;
    width(row, patch.bin) = patch.width;
    per_width(row, patch.bin) = 1 / patch.width;
  }
  literals.word("CLPV_BASIS", "CLPV_BINS")
      .integer("CLPV_SIDE", side_)
      .reals("CLPV_LINES", lines_)
      .integer("CLPV_BIN_PATCHES", patches)
      .matrix("CLPV_PATCH_X", x)
      .matrix("CLPV_PATCH_Y", y)
      .matrix("CLPV_PATCH_Z", z)
      .matrix("CLPV_PATCH_WIDTH", width)
      .matrix("CLPV_PATCH_PER_WIDTH", per_width);
}

}  // namespace clpv
