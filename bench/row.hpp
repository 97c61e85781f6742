// One row of a benchmark's results: what was timed, and what came of it.
#pragma once

#include <array>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "bench/statistics.hpp"

namespace clpv::bench {

/// What is timed: the stage and every choice that shapes it. Empty text, and numbers of 0, where it does not apply.
struct Variant {
  std::string basis;
  double lambda = 0.25;
  std::string layout = "soa", storage = "float";
  std::string state = "coefficients";
  std::string lobe = "exact";  ///< "exact", "rotate"; "rotate-kernel": rotated at run time, in the kernel
  std::string transport = "sampled";
  bool occlusion = false;
  int grid = 32;
  int iterations = 8;
  std::optional<int> cascade;
  bool filtered = true;  ///< gathering from images: by the device's filter, else from texels
  int lanes = 0;         ///< of propagation's kernels, as is `local` (pipeline/propagate.hpp); 0: as usual
  std::array<std::size_t, 2> local = {0, 1};
};

/// What the timed work comes to, counted rather than measured.
struct Cost {
  double flops = 0;  ///< that the kernels execute; a fused multiply-add is two
  double bytes = 0;  ///< that must move: each value a launch needs read once, each it makes written once
  double working_set = 0;     ///< bytes touched in all: tells which level of the memory binds
  double reads_per_cell = 0;  ///< values (or texels) fetched from volumes, a cell, all channels and all steps
  double writes_per_cell = 0;
};

enum class Status { ok, unsupported, wrong };
const char* name_of(Status status);

struct Row {
  std::string suite, stage, name;
  int n = 0;  ///< coefficients of the basis
  Variant variant;
  Status status = Status::ok;
  std::string reason;  ///< why unsupported, or where wrong
  std::string axis;    ///< of suite scaling: what grows ("grid"), and its `value`
  double value = 0;
  std::string preset;  ///< of suite frame

  std::vector<double> samples_ms;
  Statistics times;    ///< of samples_ms
  double cpu_ms = 0;   ///< processor time of all threads, mean of the samples
  double wall_ms = 0;  ///< median
  bool from_events = true;
  double first_launch_ms = 0, build_ms = 0;
  Cost cost;
  std::string ceiling;  ///< what binds: "fma", "bandwidth" or "launch"; empty where no ceilings were measured
  double ceiling_share = 0;
  std::optional<double> max_rel_error;  ///< none: nothing to hold against a twin
  double tolerance = 0;

  double gflops() const;
  double gbps() const;
};

/// Google Benchmark's keys, then clpv's (docs/benchmarks.md lists them). Both have `iterations`: it is the steps of a
/// propagation; Google Benchmark's is always 1 here.
nlohmann::json to_json(const Row& row, int index);

}  // namespace clpv::bench
