#include "basis/rotated_lobe.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "basis/srbf.hpp"
#include "support/error.hpp"

namespace clpv {
namespace {

constexpr int kLargestTable = 1 << 20;

double gram_function(const Basis& basis, double t) {
  return 4 * std::numbers::pi * abel_poisson(t, basis.lambda() * basis.lambda());
}

}  // namespace

ZonalTable::ZonalTable(int size, const std::function<double(double)>& function) {
  if (size < 2 || size > kLargestTable) {
    throw Error(ExitCode::usage, "table size is {}; allowed: 2..{}", size, kLargestTable);
  }
  for (int i = 0; i < size; ++i) values_.push_back(function(-1 + 2.0 * i / (size - 1)));
}

double ZonalTable::place(double t) const {
  return (t + 1) / 2 * (size() - 1) + kIndexBias;
}

double ZonalTable::operator()(double t) const {
  return values_[static_cast<std::size_t>(std::clamp(std::floor(place(t)), 0.0, size() - 1.0))];
}

double ZonalTable::to_step(double t) const {
  return std::abs(place(t) - std::round(place(t)));
}

ZonalTable gram_table(const Basis& basis, int size) {
  return {size, [&](double t) { return gram_function(basis, t); }};
}

ZonalTable function_table(const Basis& basis, int size) {
  return {size, [&](double t) { return abel_poisson(t, basis.lambda()); }};
}

std::vector<double> evaluate(const Basis& basis, const ZonalTable& table, const glm::dvec3& w) {
  if (basis.centres().empty()) return basis.evaluate(w);
  std::vector<double> b;
  for (const glm::dvec3& centre : basis.centres()) b.push_back(table(glm::dot(centre, w)));
  return b;
}

std::vector<double> evaluate(const Basis& basis, const LobeOptions& options, const glm::dvec3& w) {
  if (!options.table_functions || basis.centres().empty()) return basis.evaluate(w);
  return evaluate(basis, function_table(basis, options.table_size), w);
}

glm::dmat3 rotation_to(const glm::dvec3& axis) {
  // Rodrigues about +z x axis = v: R = c + [v]x + v v^T / (1 + c); glm's matrices are columns.
  const double c = axis.z;
  const glm::dvec3 v(-axis.y, axis.x, 0);
  const double square = glm::dot(v, v);  // (1 - c) (1 + c)
  if (c < 0 && square == 0) return {{1, 0, 0}, {0, -1, 0}, {0, 0, -1}};
  const double k = c < 0 ? (1 - c) / square : 1 / (1 + c);  // 1 + c loses its digits near -z
  return {{c + k * v.x * v.x, k * v.x * v.y, -v.y}, {k * v.x * v.y, c + k * v.y * v.y, v.x}, axis};
}

Lobes::Lobes(const Basis& basis, const LobeOptions& options)
    : basis_(basis),
      rotate_(options.kind == LobeKind::rotate && !basis.centres().empty()),
      upwards_(basis.clamped_cosine({0, 0, 1})) {
  if (!rotate_) return;
  if (options.table_size == 0) {
    gram_ = [&basis](double t) { return gram_function(basis, t); };
  } else {
    gram_ = gram_table(basis, options.table_size);
  }
}

std::vector<double> Lobes::operator()(const glm::dvec3& axis) const {
  if (!rotate_) return basis_.clamped_cosine(axis);
  const glm::dmat3 rotation = rotation_to(axis);
  const std::vector<glm::dvec3>& centres = basis_.centres();
  std::vector<double> turned(centres.size(), 0.0);  // R c: integrals of the turned lobe times b_i
  for (std::size_t j = 0; j < centres.size(); ++j) {
    const glm::dvec3 moved = rotation * centres[j];
    for (std::size_t i = 0; i < centres.size(); ++i)
      turned[i] += gram_(glm::dot(centres[i], moved)) * upwards_[j];
  }
  return basis_.gram_inverse() * turned;
}

}  // namespace clpv
