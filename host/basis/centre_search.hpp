// SPDX-License-Identifier: MIT
// Search for the SRBF centres that best represent clamped cosines (`clpv basis --search`; docs/bases.md, 'Searched centres').
#pragma once

#include <cstdint>
#include <functional>

#include "basis/centre_objective.hpp"
#include "support/named_enum.hpp"

namespace clpv {

/// Number of lambdas that a search optimises: none, one for all centres, or one per centre.
enum class SearchedLambdas { none, one, each };
template <>
inline constexpr auto kNames<SearchedLambdas> = name_list("none", "one", "each");

/// Parameters of a search.
struct CentreSearch {
  int centres = 8;  ///< 1 to kMaxCentres
  LobeAims aims;
  SearchedLambdas lambdas = SearchedLambdas::one;
  double lambda = kDefaultLambda;  ///< lambda of all centres, or the start value if lambdas are optimised
  /// Bound on the condition number. Rounding errors grow with its root; half precision tolerates srbf14's 1.8e4.
  double max_condition = 2e4;
  int starts = 64;  ///< number of descents from random centres
  std::uint64_t seed = 1;
};

/// Best set found.
struct CentreSearchResult {
  CentreSet set;
  double error;  ///< error_over() the aims
  int valid;     ///< number of starts that ended in a set within the bounds
};

/// Returns the best set of all starts; deterministic. Calls `after_start` after each start. Throws Error(usage) for a
/// parameter out of range, and if no start ends within the bounds (with the smallest condition bound found).
CentreSearchResult search_centres(const CentreSearch& search, const std::function<void()>& after_start = {});

}  // namespace clpv
