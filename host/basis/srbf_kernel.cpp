// SPDX-License-Identifier: MIT
#include "basis/srbf_kernel.hpp"

#include <fmt/format.h>

#include <cmath>

#include "basis/kernel_text.hpp"
#include "support/text.hpp"

namespace clpv {
namespace {

constexpr const char* kSignature =
    "(const float x, const float y, const float z) {\n  Coefficients r;\n";

// A centre, and its antipode of equal lambda if the set has one.
struct Pair {
  int centre, opposite;  // opposite is -1 if there is none
};

std::vector<Pair> antipodal_pairs(const Basis& basis) {
  std::vector<Pair> pairs;
  std::vector<bool> taken(basis.size(), false);
  for (int i = 0; i < basis.size(); ++i) {
    if (taken[i]) continue;
    Pair pair{i, -1};
    for (int j = i + 1; j < basis.size(); ++j) {
      const std::size_t a = i, b = j;
      const glm::dvec3 sum = basis.centres()[a] + basis.centres()[b];
      if (glm::dot(sum, sum) < 1e-24 && basis.lambdas()[a] == basis.lambdas()[b]) pair.opposite = j;
    }
    if (pair.opposite >= 0) taken[pair.opposite] = true;
    pairs.push_back(pair);
  }
  return pairs;
}

// "  const float t3 = w . xi_3;"
std::string height_statement(const Basis& basis, int i) {
  const glm::dvec3& xi = basis.centres()[i];
  const double factors[] = {xi.x, xi.y, xi.z};
  return fmt::format("  const float t{} = {};\n", i, sum_of_products(factors, {"x", "y", "z"}));
}

std::string evaluate_function(const Basis& basis, const std::vector<Pair>& pairs) {
  const auto value = [&](int i, int of, double sign) {
    const double lambda = basis.lambdas()[i];
    return fmt::format(
        "  const float d{0} = rsqrt(fma({1}, t{2}, {3}));\n  r.c[{0}] = {4} * d{0} * d{0} * "
        "d{0};\n",
        i, float_literal(-2 * sign * lambda), of, float_literal(1 + lambda * lambda),
        float_literal(1 - lambda * lambda));
  };
  std::string text = std::string("static inline Coefficients basis_functions") + kSignature;
  for (const Pair& pair : pairs) {
    text += height_statement(basis, pair.centre) + value(pair.centre, pair.centre, 1);
    if (pair.opposite >= 0) text += value(pair.opposite, pair.centre, -1);
  }
  return text + "  return r;\n}\n";
}

// Coefficients in u = t^2 of a Chebyshev series in x = 2u - 1.
std::vector<double> monomials(const std::vector<double>& chebyshev) {
  std::vector<double> before{1}, now{-1, 2}, sum(chebyshev.size(), 0.0);  // T_0, T_1 in u
  const auto add = [&](const std::vector<double>& p, double c) {
    for (std::size_t i = 0; i < p.size(); ++i) sum[i] += c * p[i];
  };
  add(before, chebyshev[0]);
  for (std::size_t k = 1; k < chebyshev.size(); ++k) {
    add(now, chebyshev[k]);
    std::vector<double> next(now.size() + 1, 0.0);
    for (std::size_t i = 0; i < now.size(); ++i) {
      next[i + 1] += 4 * now[i];
      next[i] -= 2 * now[i];
    }
    for (std::size_t i = 0; i < before.size(); ++i) next[i] -= before[i];
    before = now;
    now = next;
  }
  return sum;
}

// Statements that set `even` to g's even part at `t`. Horner's form in t^2 if its terms do not
// cancel (lambda up to about 0.5), else Clenshaw's recurrence, which is stable for any lambda.
std::string even_part(const std::vector<double>& chebyshev, int i) {
  const std::vector<double> c = monomials(chebyshev);
  double size = 0;
  for (const double term : c) size += std::abs(term);
  constexpr double kCancellation = 4;  // two bits of a float's 24
  if (size < kCancellation * chebyshev[0]) {
    return fmt::format("  const float u{0} = t{0} * t{0};\n  const float even{0} = {1};\n", i,
                       horner(c, fmt::format("u{}", i)));
  }
  std::string text = fmt::format("  const float u{0} = fma(4.0f * t{0}, t{0}, -2.0f);\n", i);  // 2x
  std::string next = "0.0f", after_next = "0.0f";  // b_{k+1}, b_{k+2}
  for (std::size_t k = chebyshev.size() - 1; k > 0; --k) {
    const std::string name = fmt::format("s{}_{}", i, k);
    text += fmt::format("  const float {} = fma(u{}, {}, {} - {});\n", name, i, next,
                        float_literal(chebyshev[k]), after_next);
    after_next = next;
    next = name;
  }
  return text + fmt::format("  const float even{0} = fma(0.5f * u{0}, {1}, {2} - {3});\n", i, next,
                            float_literal(chebyshev[0]), after_next);
}

std::string cosine_function(const Basis& basis, const std::vector<Pair>& pairs,
                            const std::map<double, CosineOfPoisson>& cosines) {
  std::map<double, std::vector<double>> chebyshev;
  for (const auto& [lambda, cosine] : cosines) chebyshev[lambda] = cosine.chebyshev();
  std::string text = std::string("static inline Coefficients cosine_integrals") + kSignature;
  for (const Pair& pair : pairs) {
    const int i = pair.centre;
    const double lambda = basis.lambdas()[i], slope = cosines.at(lambda).slope();
    text += height_statement(basis, i) + even_part(chebyshev[lambda], i);
    text += fmt::format("  r.c[{0}] = fma({1}, t{0}, even{0});\n", i, float_literal(slope));
    if (pair.opposite >= 0) {
      text += fmt::format("  r.c[{0}] = fma({2}, t{1}, even{1});\n", pair.opposite, i,
                          float_literal(-slope));
    }
  }
  return text + "  return r;\n}\n";
}

}  // namespace

std::string srbf_kernel_source(const Basis& basis,
                               const std::map<double, CosineOfPoisson>& cosines) {
  const std::vector<Pair> pairs = antipodal_pairs(basis);
  return evaluate_function(basis, pairs) + cosine_function(basis, pairs, cosines);
}

}  // namespace clpv
