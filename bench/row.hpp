// SPDX-License-Identifier: MIT
// One row of a benchmark's results: the timed problem, its times, cost and error.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "options/render_options.hpp"
#include "support/statistics.hpp"
#include "verify/job.hpp"

namespace clpv::bench {

using verify::Cost, verify::Status;

/// Default settings of timed stages: transport, lobes and blocking as published, volumes of layout
/// `soa` in float, no occlusion.
RenderOptions timed_options();

/// Blockers of a timed stage: as published, or none.
constexpr Blockers blockers_if(bool occlusion) {
  return occlusion ? Blockers::seen : Blockers::none;
}

/// Settings of a timed stage.
struct Problem {
  RenderOptions options = timed_options();
  std::optional<int> cascade;
  /// Gathering from images: true samples by the device's filter, false reads texels.
  bool filtered = true;
};

/// Name of the lobes: "exact", "rotate", or "rotate-kernel" for lobes rotated in the kernel at run
/// time.
std::string lobes_of(const RenderOptions& options);

struct Row {
  std::string suite, stage, name;
  int coefficients = 0;            ///< functions of the basis
  std::optional<Problem> problem;  ///< empty for rows without volumes: rasterising and ceilings
  Status status = Status::ok;
  std::string reason;  ///< reason for `unsupported`, or place of the error for `wrong`
  std::string preset;  ///< suite frame
  /// Suite frame: results each repetition recomputes: light, everything, nothing.
  std::string recompute;

  std::vector<double> samples_ms;
  Statistics times;    ///< statistics of samples_ms
  double cpu_ms = 0;   ///< processor time of all threads, mean of the samples
  double wall_ms = 0;  ///< median
  bool from_events = true;
  double first_launch_ms = 0, build_ms = 0;
  /// Peaks of the run so far: buffers, process memory.
  std::size_t device_bytes = 0, host_bytes = 0;
  Cost cost;
  std::string ceiling;  ///< binding ceiling: "fma", "bandwidth" or "launch"; empty without measured
                        ///< ceilings
  double ceiling_share = 0;
  std::optional<double> max_rel_error;  ///< against the CPU reference; empty without one
  double tolerance = 0;
  std::optional<double> published_ms;  ///< time in the paper's Table 1

  double gflops() const;
  double gbps() const;
};

/// JSON with Google Benchmark's keys and clpv's (bench/README.md lists them). `iterations` is
/// the number of propagation steps; Google Benchmark's key of that name would always be 1.
nlohmann::json to_json(const Row& row, int index);

}  // namespace clpv::bench
