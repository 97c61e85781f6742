// SPDX-License-Identifier: MIT
// Divides emissive triangles into parts with points.
#include "scene/emission.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "support/error.hpp"

namespace clpv {
namespace {

constexpr int kMaxDoublings = 24;  // distance between points; each part then has one

double brightest(const ClpvMaterial& material) {
  return std::max({material.emissive[0], material.emissive[1], material.emissive[2], 0.0f});
}

/// Divides triangles into parts by the grids that they reach.
class Planner {
 public:
  Planner(const std::vector<ClpvGrid>& grids, double spacing, std::uint32_t max_parts)
      : grids_(grids), spacing_(spacing), max_parts_(max_parts) {}

  void add(const SceneData& scene, std::uint32_t triangle) {
    triangle_ = triangle;
    sides_ = double_sided(scene.materials[scene.triangles[triangle].material]) ? 2 : 1;
    corners_ = corners_of(scene, scene.triangles[triangle]);
    const auto [a, b, c] = corners_;
    longest_ = std::max({glm::length(b - a), glm::length(c - a), glm::length(c - b)});
    if (longest_ > 0) add_range(0, 0, 1);
  }

  std::uint64_t points() const { return points_; }
  std::vector<ClpvEmitter> take() { return std::move(parts_); }

 private:
  /// The finest grid that light from a box can enter, as light starts half a cell off its surface;
  /// null if there is none.
  const ClpvGrid* reached(const glm::dvec3& lower, const glm::dvec3& upper) const {
    const auto overlaps = [&](const ClpvGrid& grid) {
      const double cell = double{grid.cell}, edge = grid.n * cell;
      for (int axis = 0; axis < 3; ++axis) {
        const double first = double{grid.origin[axis]};
        if (upper[axis] < first - cell || lower[axis] > first + edge + cell) return false;
      }
      return true;
    };
    const auto finest = std::ranges::find_if(grids_, overlaps);
    return finest == grids_.end() ? nullptr : &*finest;
  }

  /// Adds the part with corner (u, v) and edge `size`, in barycentric coordinates, or the four
  /// halves of a large one.
  void add_range(double u, double v, double size) {
    const auto at = [&](double s, double t) {
      const double w1 = u + size * s, w2 = v + size * t;
      return corners_[0] + w1 * (corners_[1] - corners_[0]) + w2 * (corners_[2] - corners_[0]);
    };
    const glm::dvec3 a = at(0, 0), b = at(1, 0), c = at(0, 1);
    const ClpvGrid* grid = reached(glm::min(a, glm::min(b, c)), glm::max(a, glm::max(b, c)));
    if (grid == nullptr) return;
    const double cell = double{grid->cell}, edge = longest_ * std::abs(size);
    if (edge > grid->n * cell) {
      const double half = size / 2;
      add_range(u, v, half);
      add_range(u + half, v, half);
      add_range(u, v + half, half);
      add_range(u + half, v + half, -half);
      return;
    }
    const auto rows =
        static_cast<std::uint32_t>(std::max(1.0, std::ceil(edge / (spacing_ * cell))));
    for (int side = 0; side < sides_; ++side) {
      if (parts_.size() == max_parts_) {
        throw Error(ExitCode::run_time,
                    "emissive triangles: found over {} parts in the cascades; allowed: up to {}",
                    max_parts_, max_parts_);
      }
      parts_.push_back({triangle_, static_cast<float>(u), static_cast<float>(v),
                        static_cast<float>(size), rows, static_cast<std::uint32_t>(points_),
                        side == 0 ? 1.0f : -1.0f, 0});
      points_ += std::uint64_t{rows} * rows;
    }
  }

  const std::vector<ClpvGrid>& grids_;
  double spacing_;  // [cells]
  std::uint32_t max_parts_;
  std::vector<ClpvEmitter> parts_;
  std::uint64_t points_ = 0;
  // The current triangle.
  std::uint32_t triangle_ = 0;
  int sides_ = 1;
  std::array<glm::dvec3, 3> corners_;
  double longest_ = 0;  // edge [m]
};

}  // namespace

std::array<glm::dvec3, 3> corners_of(const SceneData& scene, const Triangle& triangle) {
  std::array<glm::dvec3, 3> corners;
  for (std::size_t i = 0; i < 3; ++i) {
    const auto& p = scene.vertices[triangle.vertex[i]].position;
    corners[i] = {p[0], p[1], p[2]};
  }
  return corners;
}

bool double_sided(const ClpvMaterial& material) {
  return (material.flags & CLPV_MATERIAL_DOUBLE_SIDED) != 0;
}

bool emits(const ClpvMaterial& material) {
  return brightest(material) > 0;
}

std::vector<std::uint32_t> emissive_triangles(const SceneData& scene) {
  std::vector<std::uint32_t> triangles;
  for (std::uint32_t i = 0; i < scene.triangles.size(); ++i) {
    if (emits(scene.materials[scene.triangles[i].material])) triangles.push_back(i);
  }
  return triangles;
}

bool emits(const SceneData& scene) {
  return std::ranges::any_of(scene.triangles, [&](const Triangle& triangle) {
    return emits(scene.materials[triangle.material]);
  });
}

double max_emitted_flux(const SceneData& scene, const std::vector<std::uint32_t>& triangles,
                        double cell) {
  double total = 0, brightest_cell = 0;
  for (const std::uint32_t i : triangles) {
    const Triangle& triangle = scene.triangles[i];
    const ClpvMaterial& material = scene.materials[triangle.material];
    const double exitance =
        std::numbers::pi * brightest(material) * (double_sided(material) ? 2 : 1);
    const auto [a, b, c] = corners_of(scene, triangle);
    total += exitance * glm::length(glm::cross(b - a, c - a)) / 2;
    brightest_cell = std::max(brightest_cell, exitance * cell * cell);
  }
  return std::min(total, brightest_cell);
}

EmissionPlan plan_emission(const SceneData& scene, const std::vector<std::uint32_t>& triangles,
                           const std::vector<ClpvGrid>& grids, std::uint32_t max_count) {
  for (int coarsened = 0;; ++coarsened) {
    Planner planner(grids, std::ldexp(1.0 / kEmittedPointsPerCell, coarsened), max_count);
    for (const std::uint32_t triangle : triangles) planner.add(scene, triangle);
    if (planner.points() <= max_count || coarsened == kMaxDoublings)
      return {planner.take(), static_cast<std::uint32_t>(planner.points()), coarsened};
  }
}

}  // namespace clpv
