// SPDX-License-Identifier: MIT
#include "commands/tracing_options.hpp"

#include "support/error.hpp"

namespace clpv {

reference::PathTracerOptions TracingOptions::resolved() const {
  reference::PathTracerOptions result = values;
  if (bounces == "all") {
    result.bounces = reference::PathTracerOptions::kAllBounces;
  } else if (!CLI::detail::lexical_cast(bounces, result.bounces) || result.bounces < 1) {
    throw Error(ExitCode::usage, "--bounces {}: allowed: a number from 1, or all", bounces);
  }
  return result;
}

void add_tracing_options(CLI::App& command, TracingOptions& options) {
  constexpr const char* kGroup = "Path tracing";
  command
      .add_option("--bounces", options.bounces,
                  "surfaces between a light and the surface seen: 1, 2 and so on, or all")
      ->type_name("N|all")
      ->capture_default_str()
      ->group(kGroup);
  auto* samples = command.add_option("--spp", options.values.samples, "paths a pixel")
                      ->type_name("N")
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
  command.add_option("--threads", options.values.threads, "that trace (default: one a processor)")
      ->type_name("N")
      ->check(CLI::Range(1, 1024))
      ->group(kGroup);
}

}  // namespace clpv
