// SPDX-License-Identifier: MIT
// One row of a benchmark's results: what was timed, and what came of it.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "options/render_options.hpp"

namespace clpv {

namespace bench {
enum class Status { ok, unsupported, wrong };
}

template <>
inline constexpr auto kNames<bench::Status> = name_list("ok", "unsupported", "wrong");

namespace bench {

/// Of one series, in its unit. All 0 where it is empty.
struct Statistics {
  double min = 0, median = 0, p95 = 0, max = 0;
  double mad = 0;  ///< median absolute deviation from the median: a spread that a few outliers do not move
};

/// Quantiles interpolate linearly between the sorted samples, the first at 0 and the last at 1.
Statistics statistics_of(std::vector<double> samples);

/// What stages are timed with where a suite says nothing else: transport, lobes and blocking as published, volumes as
/// planes of floats, and nothing in the way.
RenderOptions timed_options();

/// What is timed of a stage: every choice that shapes it.
struct Variant {
  RenderOptions options = timed_options();
  std::optional<int> cascade;
  bool filtered = true;  ///< gathering from images: by the device's filter, else from texels
};

/// How a variant's lobes come about: "exact", "rotate", and "rotate-kernel", at run time in the kernel.
std::string lobes_of(const RenderOptions& options);

/// What the timed work comes to, counted rather than measured.
struct Cost {
  double flops = 0;  ///< that the kernels execute; a fused multiply-add is two
  double bytes = 0;  ///< that must move: each value a launch needs read once, each it makes written once
  double working_set = 0;     ///< bytes touched in all: tells which level of the memory binds
  double reads_per_cell = 0;  ///< values (or texels) fetched from volumes, a cell, all channels and all steps
  double writes_per_cell = 0;
  double triangles = 0, pixels = 0;  ///< of rasterising: those of all views
};

struct Row {
  std::string suite, stage, name;
  int n = 0;                       ///< coefficients of the basis
  std::optional<Variant> variant;  ///< none: no volumes, as of rasterising and of ceilings
  Status status = Status::ok;
  std::string reason;  ///< why unsupported, or where wrong
  std::string axis;    ///< of suite scaling: what grows ("grid"), and its `value`
  double value = 0;
  std::string preset;  ///< of suite frame
  std::string anew;  ///< of suite frame: what each repetition makes anew, "light", "everything" or "nothing"

  std::vector<double> samples_ms;
  Statistics times;    ///< of samples_ms
  double cpu_ms = 0;   ///< processor time of all threads, mean of the samples
  double wall_ms = 0;  ///< median
  bool from_events = true;
  double first_launch_ms = 0, build_ms = 0;
  std::size_t device_bytes = 0,
              host_bytes = 0;  ///< the most so far of the run: buffers, and the process's memory
  Cost cost;
  std::string ceiling;  ///< what binds: "fma", "bandwidth" or "launch"; empty where no ceilings were measured
  double ceiling_share = 0;
  std::optional<double> max_rel_error;  ///< none: nothing to hold against a CPU reference
  double tolerance = 0;
  std::optional<double> published_ms;  ///< what the paper gives for it

  double gflops() const;
  double gbps() const;
};

/// Google Benchmark's keys, then clpv's (docs/benchmarks.md lists them). Both have `iterations`: it is the steps of a
/// propagation; Google Benchmark's is always 1 here.
nlohmann::json to_json(const Row& row, int index);

}  // namespace bench
}  // namespace clpv
