// SPDX-License-Identifier: MIT
#include "codegen/mirrors.hpp"

#include <cmath>
#include <random>
#include <utility>

#include "basis/matrix.hpp"

namespace clpv {
namespace {

constexpr double kSameFunction = 1e-9;  // maximum difference of equal functions

std::vector<glm::dvec3> scattered_directions(int count) {
  std::mt19937 random(1);  // a fixed set that no mirror maps to itself
  std::normal_distribution<double> normal;
  std::vector<glm::dvec3> directions;
  for (int i = 0; i < count; ++i) {
    directions.push_back(glm::normalize(glm::dvec3(normal(random), normal(random), normal(random))));
  }
  return directions;
}

}  // namespace

SignedPermutation mirror(const Basis& basis, int axis) {
  const int n = basis.size();
  const auto directions = scattered_directions(64 * n);
  Matrix plain(static_cast<int>(directions.size()), n), mirrored = plain;
  for (int q = 0; q < plain.rows(); ++q) {
    glm::dvec3 w = directions[q];
    basis.evaluate(w, plain.row(q));
    w[axis] = -w[axis];
    basis.evaluate(w, mirrored.row(q));
  }
  SignedPermutation result;
  for (int i = 0; i < n; ++i) {
    int found = -1, found_sign = 0;
    for (int j = 0; j < n && found < 0; ++j) {
      for (const int sign : {1, -1}) {
        bool same = true;
        for (int q = 0; q < plain.rows() && same; ++q) {
          same = std::abs(mirrored(q, i) - sign * plain(q, j)) < kSameFunction;
        }
        if (same) found = j, found_sign = sign;
        if (same) break;
      }
    }
    if (found < 0) return {};
    result.target.push_back(found);
    result.sign.push_back(found_sign);
  }
  return result;
}

std::vector<SignedPermutation> Mirrors::across(int axis) const {
  return {all[(axis + 1) % 3], all[(axis + 2) % 3]};
}

Mirrors mirrors_of(const Basis& basis) {
  return {{mirror(basis, 0), mirror(basis, 1), mirror(basis, 2)}};
}

Mirrors mirrors_of_fluxes() {
  Mirrors mirrors;
  for (int axis = 0; axis < 3; ++axis) {
    mirrors.all[axis] = {{0, 1, 2, 3, 4, 5}, {1, 1, 1, 1, 1, 1}};
    std::swap(mirrors.all[axis].target[2 * axis], mirrors.all[axis].target[2 * axis + 1]);
  }
  return mirrors;
}

int axis_of(const glm::ivec3& along) {
  return along.x != 0 ? 0 : along.y != 0 ? 1 : 2;
}

}  // namespace clpv
