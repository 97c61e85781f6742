// SPDX-License-Identifier: MIT
// One row of a benchmark's results: the timed problem, its times and error.
#pragma once

#include <functional>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "device/session.hpp"
#include "options/render_options.hpp"
#include "times/time_record.hpp"
#include "verify/job.hpp"

namespace clpv::bench {

using verify::Status;

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
  int coefficients = 0;  ///< functions of the basis
  Problem problem;       ///< of the stage's volumes
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
  HostWork host;                        ///< suite frame
  std::optional<double> max_rel_error;  ///< against the CPU reference; empty without one
  double tolerance = 0;
  std::optional<double> published_ms;  ///< time in the paper's Table 1
};

/// JSON with Google Benchmark's keys and clpv's (bench/README.md lists them). `iterations` is
/// the number of propagation steps; Google Benchmark's key of that name would always be 1.
nlohmann::json to_json(const Row& row, int index);

// Jobs of a benchmark, and the cases that make them.

using verify::Deviation, verify::kChannels;

/// A job of `clpv check`, with what only its timing needs.
struct Job : verify::Job {
  /// True: `run` marks stages on the timeline itself, and the row has wall times.
  bool own_stages = false;
  /// Called after each run, warm-up included; may be null.
  std::function<void(const std::vector<StageTime>&)> after_run = {};
  /// The host's work of the last run; may be null.
  std::function<HostWork()> count = {};
  /// Returns further rows, after the job's own; may be null.
  std::function<std::vector<Row>(const Row&)> more_rows = {};
};

/// A row before its measurement: its identity, and a function that sets up its work.
struct Case {
  Row row;  ///< suite, stage, name, n and problem
  /// Builds kernels and allocates; Error(device) makes the row `unsupported`.
  std::function<Job()> make;
};

// Results of a benchmark as text: JSON with Google Benchmark's keys, or a table.

/// {"context": ..., "benchmarks": [row, ...]}. Context: Google Benchmark's keys (date, host_name,
/// num_cpus, load_avg ...) and clpv's (schema, clpv_version, git_describe, host_cpu, platform,
/// device, driver, compute_units, build_options, kernel_hash), and the scene.
nlohmann::json report_json(const Session& session, const std::string& scene,
                           const std::vector<Row>& rows);

/// [{"name", "unit": "ms", "value", "range"}, ...]: medians and MADs of the rows of status ok, in
/// the form that GitHub's benchmark actions read (smaller is better).
std::string report_github_action(const std::vector<Row>& rows);

/// Table with a line per row: name, median, MAD, wall time, error.
std::string report_table(const std::vector<Row>& rows);

}  // namespace clpv::bench
