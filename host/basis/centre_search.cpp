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

constexpr double kLeastLambda = 0.02, kMostLambda = 0.9;  // beyond, kernels are flat or needles
constexpr int kMostSteps = 500;                           // of a start; most end after 50 to 200
constexpr double kTolerance = 1e-10;                      // of the square error's change in a step, relative
constexpr double kSlack = 1e-6;  // of ln(condition): what an optimiser may leave of a bound

// Where a step leads to a singular set: worse than any other, so that line searches turn back.
constexpr double kNoError = 10, kNoCondition = 100;

/// Unknowns: three numbers a centre, of which the direction counts, then one, N or no lambdas.
struct Unknowns {
  const CentreSearch& search;

  std::size_t centres() const { return static_cast<std::size_t>(search.centres); }
  std::size_t lambdas() const {
    if (search.lambdas == SearchedLambdas::none) return 0;
    return search.lambdas == SearchedLambdas::one ? 1 : centres();
  }
  std::size_t count() const { return 3 * centres() + lambdas(); }

  glm::dvec3 place(const double* x, std::size_t i) const {
    const glm::dvec3 v(x[3 * i], x[3 * i + 1], x[3 * i + 2]);
    return glm::dot(v, v) > 0 ? v : glm::dvec3(0, 0, 1);
  }
  CentreSet set(const double* x) const {
    CentreSet set;
    for (std::size_t i = 0; i < centres(); ++i) {
      set.centres.push_back(glm::normalize(place(x, i)));
      set.lambdas.push_back(lambdas() == 0 ? search.lambda : x[3 * centres() + (lambdas() == 1 ? 0 : i)]);
    }
    return set;
  }
  void slopes(const SetValue& value, const double* x, double* slopes) const {
    std::fill(slopes, slopes + count(), 0.0);
    for (std::size_t i = 0; i < centres(); ++i) {
      const glm::dvec3 v = place(x, i), along = glm::normalize(v);
      const glm::dvec3 slope =
          (value.by_centre[i] - glm::dot(value.by_centre[i], along) * along) / glm::length(v);
      for (int axis = 0; axis < 3; ++axis) slopes[3 * i + static_cast<std::size_t>(axis)] = slope[axis];
      if (lambdas() != 0) slopes[3 * centres() + (lambdas() == 1 ? 0 : i)] += value.by_lambda[i];
    }
  }
};

/// What the optimiser calls; no exception may pass through it.
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

double uniform(std::mt19937_64& random) {  // the standard's distributions differ between libraries
  return static_cast<double>(random() >> 11) * 0x1p-53;
}

std::vector<double> start(const Unknowns& unknowns, std::mt19937_64& random) {
  std::vector<double> x;
  for (std::size_t i = 0; i < unknowns.centres(); ++i) {
    const double z = 2 * uniform(random) - 1, azimuth = 2 * std::numbers::pi * uniform(random);
    const double radius = std::sqrt(1 - z * z);
    x.insert(x.end(), {radius * std::cos(azimuth), radius * std::sin(azimuth), z});
  }
  x.resize(unknowns.count(), std::clamp(unknowns.search.lambda, kLeastLambda, kMostLambda));
  return x;
}

/// Where a start ends.
std::vector<double> descended(Problem& problem, std::vector<double> x) {
  const auto count = static_cast<unsigned>(x.size());
  const std::unique_ptr<nlopt_opt_s, void (*)(nlopt_opt)> optimiser(nlopt_create(NLOPT_LD_SLSQP, count),
                                                                    nlopt_destroy);
  if (!optimiser) throw Error(ExitCode::run_time, "the optimiser cannot be made");
  std::vector<double> least(x.size(), -std::numeric_limits<double>::infinity()),
      most(x.size(), std::numeric_limits<double>::infinity());
  for (std::size_t i = 3 * problem.unknowns.centres(); i < x.size(); ++i)
    least[i] = kLeastLambda, most[i] = kMostLambda;
  nlopt_set_lower_bounds(optimiser.get(), least.data());
  nlopt_set_upper_bounds(optimiser.get(), most.data());
  nlopt_set_min_objective(optimiser.get(), error_of, &problem);
  nlopt_add_inequality_constraint(optimiser.get(), excess_of, &problem, kSlack);
  nlopt_set_ftol_rel(optimiser.get(), kTolerance);
  nlopt_set_maxeval(optimiser.get(), kMostSteps);
  double error = 0;
  // Rounding that stops a descent is an end like another: what came of it is looked at below.
  nlopt_optimize(optimiser.get(), x.data(), &error);
  return x;
}

/// Whether a basis can be made of it: two centres that met, each with a lambda of its own, are rejected there.
bool usable(const CentreSet& set) {
  try {
    make_basis_from_centres("found", set.centres, set.lambdas);
    return true;
  } catch (const Error&) {
    return false;
  }
}

void require(const CentreSearch& search) {
  if (search.centres < 1 || search.centres > static_cast<int>(kMostCentres)) {
    throw Error(ExitCode::usage, "--search {}: allowed: 1 to {} centres", search.centres, kMostCentres);
  }
  if (!(search.lambda > 0 && search.lambda < 1)) {
    throw Error(ExitCode::usage, "lambda is {}; allowed: between 0 and 1, both excluded", search.lambda);
  }
  if (!(search.most_condition >= 1 && search.most_condition <= kLargestCondition)) {
    throw Error(ExitCode::usage, "--most-condition {}: allowed: 1 to {:.0e}", search.most_condition,
                kLargestCondition);
  }
}

}  // namespace

FoundCentres search_centres(const CentreSearch& search, const std::function<void()>& after_start) {
  require(search);
  Problem problem{{search}, CentreObjective(search.aims), std::log(search.most_condition)};
  std::mt19937_64 random(search.seed);
  std::optional<FoundCentres> best;
  double nearest = std::numeric_limits<double>::infinity();
  int valid = 0;
  for (int number = 0; number < search.starts; ++number) {
    const std::vector<double> x = descended(problem, start(problem.unknowns, random));
    const double excess = problem.excess(x.data(), nullptr), square = problem.error(x.data(), nullptr);
    nearest = std::min(nearest, excess);
    if (after_start) after_start();
    const CentreSet set = problem.unknowns.set(x.data());
    if (!(excess <= 2 * kSlack) || !usable(set)) continue;
    ++valid;
    const double error = std::sqrt(std::max(0.0, square));
    if (!best || error < best->error) best = {set, error, 0};
  }
  if (!best) {
    throw Error(
        ExitCode::usage,
        "--search {}: none of {} starts ends in a set whose condition number is at most {:.3g}; the nearest "
        "has {:.3g} at most; take a larger lambda, fewer centres or a larger --most-condition",
        search.centres, search.starts, search.most_condition,
        search.most_condition * std::exp(std::min(nearest, kNoCondition)));
  }
  best->valid = valid;
  return *best;
}

}  // namespace clpv
