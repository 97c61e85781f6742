// SPDX-License-Identifier: MIT
#include "cli/tracing_options.hpp"

#include "cli/options.hpp"
#include "support/error.hpp"
#include "support/text.hpp"

namespace clpv {

reference::PathTracerOptions TracingOptions::resolved() const {
  reference::PathTracerOptions result = values;
  if (bounces == "all") {
    result.bounces = reference::PathTracerOptions::kAllBounces;
  } else {
    result.bounces = parse_number<int>(bounces).value_or(0);
    if (result.bounces < 1)
      throw Error(ExitCode::usage, "--bounces {}: allowed: a number from 1, or all", bounces);
  }
  return result;
}

void add_tracing_options(CLI::App& command, TracingOptions& options) {
  constexpr const char* kGroup = "Path tracing";
  add(command, "--bounces", "N|all", options.bounces,
      "surfaces between a light and the surface seen: 1, 2 and so on, or all")
      ->group(kGroup);
  auto* samples = add(command, "--spp", "N", options.values.samples, "paths a pixel")
                      ->check(CLI::Range(1u, reference::PathTracerOptions::kMostSamples))
                      ->group(kGroup);
  command
      .add_option(
          "--noise", options.values.noise,
          "stops once the standard error of the indirect light is this share of it (root mean square)")
      ->check(CLI::PositiveNumber)
      ->excludes(samples)
      ->capture_default_str()
      ->group(kGroup);
  command.add_option("--seed", options.values.seed, "the same seed gives the same bytes")
      ->capture_default_str()
      ->group(kGroup);
  add(command, "--threads", "N", options.values.threads, "that trace (default: one a processor)")
      ->check(CLI::Range(1, 1024))
      ->group(kGroup);
}

reference::TraceProgress shown_on(Progress& progress) {
  return [&progress](double share) { progress.reach(static_cast<std::uint64_t>(share * kTraceSteps)); };
}

}  // namespace clpv
