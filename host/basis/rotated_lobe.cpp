// SPDX-License-Identifier: MIT
#include "basis/rotated_lobe.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "basis/bases.hpp"
#include "support/error.hpp"

namespace clpv {
namespace {

constexpr int kMaxTableSize = 1 << 20;
constexpr std::size_t kMaxEntries = std::size_t{1} << 24;  // sum over all tables: 64 MiB

double gram_function(double t, double product) {
  return 4 * std::numbers::pi * abel_poisson(t, product);
}

Parameters distinct(const std::vector<double>& all) {
  Parameters parameters;
  for (const double value : all) {
    const auto found = std::ranges::find(parameters.values, value);
    parameters.index.push_back(static_cast<std::size_t>(found - parameters.values.begin()));
    if (found == parameters.values.end()) parameters.values.push_back(value);
  }
  return parameters;
}

ZonalTables tables_of(const Parameters& parameters, int size,
                      double (*function)(double t, double parameter)) {
  if (static_cast<std::size_t>(std::max(0, size)) * parameters.values.size() > kMaxEntries) {
    throw Error(ExitCode::usage,
                "table size: found {}, with which {} tables have more than {} entries in total",
                size, parameters.values.size(), kMaxEntries);
  }
  ZonalTables tables{{}, parameters.index};
  for (const double value : parameters.values)
    tables.tables.emplace_back(size, [&](double t) { return function(t, value); });
  return tables;
}

}  // namespace

float dot_in_float(const glm::dvec3& a, const glm::dvec3& b) {
  // Double holds products of floats exactly, and the casts prevent fused multiply-adds.
  const glm::vec3 p(a), q(b);
  const auto x = static_cast<float>(double{p.x} * q.x), y = static_cast<float>(double{p.y} * q.y),
             z = static_cast<float>(double{p.z} * q.z);
  return x + y + z;
}

ZonalTable::ZonalTable(int size, const std::function<double(double)>& function) {
  if (size < 2 || size > kMaxTableSize) {
    throw Error(ExitCode::usage, "table size: found {}, allowed: 2..{}", size, kMaxTableSize);
  }
  for (int i = 0; i < size; ++i) values_.push_back(function(-1 + 2.0 * i / (size - 1)));
}

double ZonalTable::operator()(float t) const {
  const int index = static_cast<int>((t + 1) * 0.5f * static_cast<float>(size() - 1));
  return values_[static_cast<std::size_t>(std::clamp(index, 0, size() - 1))];
}

double ZonalTable::to_step(double t) const {
  const double position = (t + 1) / 2 * (size() - 1);
  return std::abs(position - std::round(position));
}

Parameters gram_parameters(const Basis& basis) {
  std::vector<double> products;
  for (const double a : basis.lambdas()) {
    for (const double b : basis.lambdas()) products.push_back(a * b);
  }
  return distinct(products);
}

Parameters function_parameters(const Basis& basis) {
  return distinct(basis.lambdas());
}

std::vector<float> ZonalTables::values() const {
  std::vector<float> all;
  for (const ZonalTable& table : tables) {
    const std::vector<float> values = table.values();
    all.insert(all.end(), values.begin(), values.end());
  }
  return all;
}

ZonalTables gram_tables(const Basis& basis, int size) {
  return tables_of(gram_parameters(basis), size, gram_function);
}

ZonalTables function_tables(const Basis& basis, int size) {
  return tables_of(function_parameters(basis), size, abel_poisson);
}

std::vector<double> evaluate(const Basis& basis, const ZonalTables& tables, const glm::dvec3& w) {
  if (basis.centres().empty()) return basis.evaluate(w);
  std::vector<double> b;
  for (const glm::dvec3& centre : basis.centres())
    b.push_back(tables(b.size(), dot_in_float(centre, w)));
  return b;
}

std::vector<double> evaluate(const Basis& basis, const LobeOptions& options, const glm::dvec3& w) {
  if (!options.table_functions || basis.centres().empty()) return basis.evaluate(w);
  return evaluate(basis, function_tables(basis, options.table_size), w);
}

glm::dmat3 rotation_to(const glm::dvec3& axis) {
  // Rodrigues about +z x axis = v: R = c + [v]x + v v^T / (1 + c); glm's matrices are columns.
  const double c = axis.z;
  const glm::dvec3 v(-axis.y, axis.x, 0);
  const double square = glm::dot(v, v);  // (1 - c) (1 + c)
  if (c < 0 && square == 0) return {{1, 0, 0}, {0, -1, 0}, {0, 0, -1}};
  const double k = c < 0 ? (1 - c) / square : 1 / (1 + c);  // 1 + c is inaccurate near -z
  return {{c + k * v.x * v.x, k * v.x * v.y, -v.y}, {k * v.x * v.y, c + k * v.y * v.y, v.x}, axis};
}

Lobes::Lobes(const Basis& basis, const LobeOptions& options)
    : basis_(basis),
      rotate_(options.kind == LobeKind::rotate && !basis.centres().empty()),
      up_lobe_(basis.clamped_cosine({0, 0, 1})) {
  if (rotate_ && options.table_size != 0) tables_ = gram_tables(basis, options.table_size);
}

double Lobes::gram(std::size_t i, std::size_t j, const glm::dvec3& a, const glm::dvec3& b) const {
  if (tables_) return (*tables_)(i * basis_.lambdas().size() + j, dot_in_float(a, b));
  return gram_function(glm::dot(a, b), basis_.lambdas()[i] * basis_.lambdas()[j]);
}

std::vector<double> Lobes::operator()(const glm::dvec3& axis) const {
  if (!rotate_) return basis_.clamped_cosine(axis);
  const glm::dmat3 rotation = rotation_to(axis);
  const std::vector<glm::dvec3>& centres = basis_.centres();
  std::vector<double> rotated(centres.size(), 0.0);  // R c: integrals of the rotated lobe times b_i
  for (std::size_t j = 0; j < centres.size(); ++j) {
    const glm::dvec3 centre = rotation * centres[j];
    for (std::size_t i = 0; i < centres.size(); ++i)
      rotated[i] += gram(i, j, centres[i], centre) * up_lobe_[j];
  }
  return basis_.gram_inverse() * rotated;
}

}  // namespace clpv
