// SPDX-License-Identifier: MIT
#include "basis/basis.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <functional>

#include "basis/bases.hpp"
#include "support/error.hpp"

namespace clpv {
namespace {

constexpr int kMinBands = 2, kMaxBands = 5;
constexpr int kBinSides[] = {2, 4};  // bins along each edge of a cube face

}  // namespace

void Basis::set_gram(Matrix gram, std::vector<double> integrals) {
  condition_ = condition_number(gram);
  if (!(condition_ <= kMaxCondition)) {
    throw Error(ExitCode::usage,
                "lambda: found {} with basis {}, whose Gram matrix then has a condition number of "
                "{:.3g}; allowed: a larger one, with which it is at most {:.0e}",
                lambda_text(), name_, condition_, kMaxCondition);
  }
  gram_inverse_ = inverse(gram);
  gram_ = std::move(gram);
  integrals_ = std::move(integrals);
}

double Basis::lambda() const {
  const bool one = !lambdas_.empty() &&
                   std::ranges::adjacent_find(lambdas_, std::not_equal_to()) == lambdas_.end();
  return one ? lambdas_.front() : 0;
}

std::string Basis::lambda_text() const {
  if (lambda() != 0 || lambdas_.empty()) return fmt::format("{}", lambda());
  const auto [smallest, largest] = std::ranges::minmax(lambdas_);
  return fmt::format("{:.3g} to {:.3g}", smallest, largest);
}

std::vector<double> Basis::evaluate(const glm::dvec3& w) const {
  std::vector<double> b(size_);
  evaluate(w, b);
  return b;
}

double Basis::value(std::span<const double> c, const glm::dvec3& w) const {
  return dot(c, evaluate(w));
}

double Basis::energy(std::span<const double> c) const {
  return dot(c, integrals_);
}

std::vector<double> Basis::clamped_cosine(const glm::dvec3& d) const {
  std::vector<double> alpha(size_);
  cosine_integrals(d, alpha);
  return gram_inverse_ * alpha;
}

std::vector<double> Basis::constant() const {
  return gram_inverse_ * integrals_;
}

std::unique_ptr<Basis> make_basis(const std::string& name, double lambda) {
  for (int bands = kMinBands; bands <= kMaxBands; ++bands) {
    if (name == fmt::format("sh{}", bands)) return std::make_unique<SphericalHarmonics>(bands);
  }
  for (const SrbfSet& set : srbf_sets()) {
    if (name == set.name) return make_basis_from_centres(name, set.centres, lambda);
  }
  for (const int side : kBinSides) {
    if (name == fmt::format("bins{}", 6 * side * side))
      return std::make_unique<DirectionBins>(side);
  }
  throw Error(ExitCode::usage, "basis: found '{}', allowed: {}", name,
              fmt::join(basis_names(), ", "));
}

std::unique_ptr<Basis> make_basis_from_centres(const std::string& name,
                                               const std::vector<glm::dvec3>& centres,
                                               double lambda) {
  return make_basis_from_centres(name, centres, std::vector<double>(centres.size(), lambda));
}

std::unique_ptr<Basis> make_basis_from_centres(const std::string& name,
                                               const std::vector<glm::dvec3>& centres,
                                               const std::vector<double>& lambdas) {
  return std::make_unique<Srbf>(name, centres, lambdas);
}

std::vector<std::string> basis_names() {
  std::vector<std::string> names;
  for (int bands = kMinBands; bands <= kMaxBands; ++bands)
    names.push_back(fmt::format("sh{}", bands));
  for (const SrbfSet& set : srbf_sets()) names.push_back(set.name);
  for (const int side : kBinSides) names.push_back(fmt::format("bins{}", 6 * side * side));
  return names;
}

}  // namespace clpv
