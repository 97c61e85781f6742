// SPDX-License-Identifier: MIT
// Numbers of paths on the way to a noise.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "pathtracer/path_tracer.hpp"
#include "support/error.hpp"

namespace clpv::pathtracer {

/// Paths before the first estimate of the noise that may end the tracing.
inline constexpr std::uint32_t kFirstSamples = 64;

/// The next number of paths, of the sequence 2^k, 3 * 2^(k-1), 2^(k+1), where Sobol points have the
/// lowest discrepancy.
inline std::uint32_t next_count(std::uint32_t samples) {
  const bool power = (samples & (samples - 1)) == 0;
  return power ? samples + samples / 2 : samples / 3 * 4;
}

/// Expected number of paths for the target noise, as the error of scrambled Sobol points falls with
/// n^(-3/4).
inline double expected_count(std::uint32_t samples, double noise, double target) {
  return samples * std::pow(std::max(1.0, noise / target), 4.0 / 3.0);
}

/// Throws Error(usage) for options out of range.
inline void check(const PathTracerOptions& options) {
  if (options.bounces < 0)
    throw Error(ExitCode::usage, "bounces: found {}; allowed: 1 or more, or 0 for all",
                options.bounces);
  if (options.samples > PathTracerOptions::kMaxSamples)
    throw Error(ExitCode::usage, "samples: found {}; allowed: 0 to {}", options.samples,
                PathTracerOptions::kMaxSamples);
  if (options.threads < 0 || options.threads > PathTracerOptions::kMaxThreads)
    throw Error(ExitCode::usage, "threads: found {}; allowed: 1 to {}, or 0 for one per processor",
                options.threads, PathTracerOptions::kMaxThreads);
  if (!(options.noise > 0))
    throw Error(ExitCode::usage, "noise: found {}; allowed: above 0", options.noise);
}

}  // namespace clpv::pathtracer
