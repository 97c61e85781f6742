// SPDX-License-Identifier: MIT
// The options of path tracing on the command line, shared by `reference` and `quality`, and its progress bar.
#pragma once

#include <CLI/CLI.hpp>
#include <algorithm>
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

/// A bar fed with shares of the whole in [0, 1].
class TraceBar {
 public:
  explicit TraceBar(const std::string& title) : progress_(title, kSteps) {}
  void show(double share) {
    const auto step = static_cast<std::uint64_t>(share * kSteps);
    if (step > shown_) progress_.advance(step - shown_);
    shown_ = std::max(shown_, step);  // an estimate may turn out too hopeful; the bar then waits
  }

 private:
  static constexpr std::uint64_t kSteps = 10000;
  Progress progress_;
  std::uint64_t shown_ = 0;
};

}  // namespace clpv
