// SPDX-License-Identifier: MIT
// Results of a benchmark as text: JSON with Google Benchmark's keys, or a table.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "bench/ceilings.hpp"
#include "bench/row.hpp"
#include "device/session.hpp"

namespace clpv::bench {

/// Context of a run: Google Benchmark's keys (date, host_name, num_cpus, load_avg ...) and clpv's
/// (schema, clpv_version, git_describe, host_cpu, platform, device, driver, compute_units,
/// build_options, kernel_hash).
nlohmann::json context_json(const Session& session);

/// {"context": ..., "benchmarks": [row, ...]}; `ceilings` becomes context/ceilings: gflops,
/// bandwidths[], launch_ms.
nlohmann::json report_json(const nlohmann::json& context, const Ceilings& ceilings,
                           const std::vector<Row>& rows);

/// [{"name", "unit": "ms", "value", "range"}, ...]: medians and MADs of the rows of status ok, in
/// the form that GitHub's benchmark actions read (smaller is better).
std::string report_github_action(const std::vector<Row>& rows);

/// Table with a line per row: name, median, MAD, wall time, GFLOP/s, GB/s, share of the ceiling,
/// error.
std::string report_table(const std::vector<Row>& rows);

}  // namespace clpv::bench
