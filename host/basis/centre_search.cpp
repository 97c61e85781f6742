// SPDX-License-Identifier: MIT
#include "basis/centre_search.hpp"

#include <nlopt.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <numbers>
#include <optional>
#include <random>

#include "support/error.hpp"

namespace clpv {
namespace {

constexpr double kMinLambda = 0.02,
                 kMaxLambda = 0.9;    // beyond these, functions are nearly constant or needles
constexpr int kMaxSteps = 500;        // per start; most starts need 50 to 200
constexpr double kTolerance = 1e-10;  // relative change of the square error per step
constexpr double kSlack = 1e-6;       // tolerance of the bound on ln(condition)

// Values of singular sets: worse than any other, so that line searches turn back.
constexpr double kNoError = 10, kNoCondition = 100;

/// Unknowns of the search: three numbers per centre, of which only the direction counts; then 0, 1 or N lambdas.
struct Unknowns {
  const CentreSearch& search;

  std::size_t centres() const { return static_cast<std::size_t>(search.centres); }
  std::size_t lambdas() const {
    if (search.lambdas == SearchedLambdas::none) return 0;
    return search.lambdas == SearchedLambdas::one ? 1 : centres();
  }
  std::size_t count() const { return 3 * centres() + lambdas(); }

  glm::dvec3 vector(const double* x, std::size_t i) const {
    const glm::dvec3 v(x[3 * i], x[3 * i + 1], x[3 * i + 2]);
    return glm::dot(v, v) > 0 ? v : glm::dvec3(0, 0, 1);
  }
  CentreSet set(const double* x) const {
    CentreSet set;
    for (std::size_t i = 0; i < centres(); ++i) {
      set.centres.push_back(glm::normalize(vector(x, i)));
      set.lambdas.push_back(lambdas() == 0 ? search.lambda : x[3 * centres() + (lambdas() == 1 ? 0 : i)]);
    }
    return set;
  }
  void slopes(const SetValue& value, const double* x, double* slopes) const {
    std::fill(slopes, slopes + count(), 0.0);
    for (std::size_t i = 0; i < centres(); ++i) {
      const glm::dvec3 v = vector(x, i), along = glm::normalize(v);
      const glm::dvec3 slope =
          (value.by_centre[i] - glm::dot(value.by_centre[i], along) * along) / glm::length(v);
      for (int axis = 0; axis < 3; ++axis) slopes[3 * i + static_cast<std::size_t>(axis)] = slope[axis];
      if (lambdas() != 0) slopes[3 * centres() + (lambdas() == 1 ? 0 : i)] += value.by_lambda[i];
    }
  }
};

/// Objective and constraint for the optimiser. No exception may pass through the optimiser, a C library.
struct Problem {
  Unknowns unknowns;
  CentreObjective objective;
  double log_limit;

  template <typename Function>
  double evaluate(const double* x, double* slopes, double otherwise, Function function) const {
    try {
      const SetValue value = function(unknowns.set(x));
      if (slopes != nullptr) unknowns.slopes(value, x, slopes);
      return std::isfinite(value.value) ? value.value : otherwise;
    } catch (const Error&) {
      if (slopes != nullptr) std::fill(slopes, slopes + unknowns.count(), 0.0);
      return otherwise;
    }
  }
  double error(const double* x, double* slopes) const {
    return evaluate(x, slopes, kNoError, [&](const CentreSet& set) { return objective.square_error(set); });
  }
  double excess(const double* x, double* slopes) const {
    return evaluate(x, slopes, kNoCondition, [&](const CentreSet& set) {
      SetValue value = objective.log_condition(set);
      value.value -= log_limit;
      return value;
    });
  }
};

double error_of(unsigned, const double* x, double* slopes, void* problem) {
  return static_cast<const Problem*>(problem)->error(x, slopes);
}

double excess_of(unsigned, const double* x, double* slopes, void* problem) {
  return static_cast<const Problem*>(problem)->excess(x, slopes);
}

double uniform(std::mt19937_64& random) {  // std distributions differ between libraries
  return static_cast<double>(random() >> 11) * 0x1p-53;
}

/// Random start values.
std::vector<double> random_start(const Unknowns& unknowns, std::mt19937_64& random) {
  std::vector<double> x;
  for (std::size_t i = 0; i < unknowns.centres(); ++i) {
    const double z = 2 * uniform(random) - 1, azimuth = 2 * std::numbers::pi * uniform(random);
    const double radius = std::sqrt(1 - z * z);
    x.insert(x.end(), {radius * std::cos(azimuth), radius * std::sin(azimuth), z});
  }
  x.resize(unknowns.count(), std::clamp(unknowns.search.lambda, kMinLambda, kMaxLambda));
  return x;
}

/// Returns the local minimum found from `x` (SLSQP: Kraft 1988).
std::vector<double> minimised(Problem& problem, std::vector<double> x) {
  const auto count = static_cast<unsigned>(x.size());
  const std::unique_ptr<nlopt_opt_s, void (*)(nlopt_opt)> optimiser(nlopt_create(NLOPT_LD_SLSQP, count),
                                                                    nlopt_destroy);
  if (!optimiser) throw Error(ExitCode::run_time, "cannot create the optimiser");
  std::vector<double> lower(x.size(), -std::numeric_limits<double>::infinity()),
      upper(x.size(), std::numeric_limits<double>::infinity());
  for (std::size_t i = 3 * problem.unknowns.centres(); i < x.size(); ++i)
    lower[i] = kMinLambda, upper[i] = kMaxLambda;
  nlopt_set_lower_bounds(optimiser.get(), lower.data());
  nlopt_set_upper_bounds(optimiser.get(), upper.data());
  nlopt_set_min_objective(optimiser.get(), error_of, &problem);
  nlopt_add_inequality_constraint(optimiser.get(), excess_of, &problem, kSlack);
  nlopt_set_ftol_rel(optimiser.get(), kTolerance);
  nlopt_set_maxeval(optimiser.get(), kMaxSteps);
  double error = 0;
  // The status does not matter: the caller checks the result, even if rounding stopped the descent.
  nlopt_optimize(optimiser.get(), x.data(), &error);
  return x;
}

/// Returns true if a basis can be built from `set`: it rejects two centres at one place.
bool usable(const CentreSet& set) {
  try {
    make_basis_from_centres("found", set.centres, set.lambdas);
    return true;
  } catch (const Error&) {
    return false;
  }
}

void require(const CentreSearch& search) {
  if (search.centres < 1 || search.centres > static_cast<int>(kMaxCentres)) {
    throw Error(ExitCode::usage, "--search: found {}, allowed: 1 to {} centres", search.centres, kMaxCentres);
  }
  if (!(search.lambda > 0 && search.lambda < 1)) {
    throw Error(ExitCode::usage, "lambda: found {}, allowed: greater than 0 and less than 1", search.lambda);
  }
  if (!(search.max_condition >= 1 && search.max_condition <= kMaxCondition)) {
    throw Error(ExitCode::usage, "--max-condition: found {}, allowed: 1 to {:.0e}", search.max_condition,
                kMaxCondition);
  }
}

}  // namespace

CentreSearchResult search_centres(const CentreSearch& search, const std::function<void()>& after_start) {
  require(search);
  Problem problem{{search}, CentreObjective(search.aims), std::log(search.max_condition)};
  std::mt19937_64 random(search.seed);
  std::optional<CentreSearchResult> best;
  double smallest_excess = std::numeric_limits<double>::infinity();
  int valid = 0;
  for (int number = 0; number < search.starts; ++number) {
    const std::vector<double> x = minimised(problem, random_start(problem.unknowns, random));
    const double excess = problem.excess(x.data(), nullptr), square = problem.error(x.data(), nullptr);
    smallest_excess = std::min(smallest_excess, excess);
    if (after_start) after_start();
    const CentreSet set = problem.unknowns.set(x.data());
    if (!(excess <= 2 * kSlack) || !usable(set)) continue;
    ++valid;
    const double error = std::sqrt(std::max(0.0, square));
    if (!best || error < best->error) best = {set, error, 0};
  }
  if (!best) {
    throw Error(ExitCode::usage,
                "--search {}: none of {} starts found a set with a condition number of at most {:.3g}; "
                "smallest bound "
                "found: {:.3g}; use a larger lambda, fewer centres or a larger --max-condition",
                search.centres, search.starts, search.max_condition,
                search.max_condition * std::exp(std::min(smallest_excess, kNoCondition)));
  }
  best->valid = valid;
  return *best;
}

}  // namespace clpv
