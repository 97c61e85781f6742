// SPDX-License-Identifier: MIT
// The options of path tracing on the command line, shared by `reference` and `quality`.
#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <string>

#include "pathtracer/path_tracer.hpp"
#include "support/progress.hpp"

namespace clpv {

struct TracingOptions {
  std::string bounces = "1";
  reference::PathTracerOptions values;  ///< all but `bounces`

  /// Throws Error(usage) for --bounces that are neither a number from 1 nor all.
  reference::PathTracerOptions resolved() const;
};

/// --bounces, --spp, --noise, --seed and --threads; `options` must outlive the parse.
void add_tracing_options(CLI::App& command, TracingOptions& options);

/// Shows on a bar what trace_paths tells it.
reference::TraceProgress shown_on(Progress& progress);
inline constexpr std::uint64_t kTraceSteps = 10000;  ///< of such a bar

}  // namespace clpv
