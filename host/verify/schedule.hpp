// SPDX-License-Identifier: MIT
// Runs the table of comparisons, in this process or in helper processes, so that no driver error
// ends the check.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "support/helpers.hpp"
#include "verify/check.hpp"

namespace clpv::verify {

/// The comparisons that a user chose.
struct CheckChoice {
  std::vector<Stage> stages;         ///< empty: all
  std::vector<std::string> match;    ///< texts that names must contain
  bool thorough = false;             ///< thorough_scope()
  std::optional<PresetName> preset;  ///< only its combination of options
  std::vector<std::size_t> only;     ///< numbers among those that all others choose; empty: all

  /// Returns the chosen cases in order. Throws Error(usage) if there is none.
  Cases cases() const;
  /// Returns the arguments of `clpv` that choose the same cases.
  std::vector<std::string> arguments() const;
};

/// Receives the results of each case, in order.
using Finished = std::function<void(const CheckResults&)>;
/// Receives how many cases are finished; helpers finish the last cases first.
using Reached = std::function<void(std::size_t)>;

/// Runs all cases in this process. Throws Interrupted.
void run_here(const Cases& cases, Session& session, const Finished& finished);

/// Runs the cases in helper processes, which `arguments` start and which compile side by side. A
/// driver's crash or endless compilation (docs/devices.md) then costs one comparison, not all. A
/// case fails whose helper ends by a signal or takes more than `limit` seconds; another helper then
/// takes its place. Throws Interrupted.
void run_in_helpers(
    const Cases& cases, const std::vector<std::string>& arguments, double limit,
    const Finished& finished, const Reached& reached = [](std::size_t) {});

/// The work of a helper: takes whole stages, since their cases share kernels, and then single cases
/// of stages that others took, until none is left.
void help(const Cases& cases, const std::function<CheckResults(const Case&)>& run,
          const Claims& claims);

/// Keys: stage, variant, status, passed, worst, allowed, place, reason, seconds. NaN becomes null.
nlohmann::json to_json(const CheckResult& result);

}  // namespace clpv::verify
