// SPDX-License-Identifier: MIT
// A search for the centres of an SRBF set that hold clamped cosines best (`clpv basis --search`).
#pragma once

#include <cstdint>
#include <functional>

#include "basis/centre_objective.hpp"
#include "support/named_enum.hpp"

namespace clpv {

/// How many lambdas a search finds.
enum class SearchedLambdas { none, one, each };
template <>
inline constexpr auto kNames<SearchedLambdas> = name_list("none", "one", "each");

struct CentreSearch {
  int centres = 8;  ///< 1 to kMostCentres
  LobeAims aims;
  SearchedLambdas lambdas = SearchedLambdas::one;
  double lambda =
      kDefaultLambda;  ///< of all centres where none is searched for; else where the search begins
  /// Coefficients grow with the root of it and take as much off the last digits: halves still bear srbf14's 1.8e4.
  double most_condition = 2e4;
  int starts = 64;  ///< from random centres
  std::uint64_t seed = 1;
};

struct FoundCentres {
  CentreSet set;
  double error;  ///< error_over() the aims
  int valid;     ///< of how many starts the end was a set within the bounds
};

/// The best of all starts; the same for the same arguments. `after_start` hears of each start's end.
/// Throws Error(usage) for a number out of range, and where no start ends within the bounds, telling how near the best
/// one came.
FoundCentres search_centres(const CentreSearch& search, const std::function<void()>& after_start = {});

}  // namespace clpv
