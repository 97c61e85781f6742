// SPDX-License-Identifier: MIT
// A benchmark's results as text: JSON in Google Benchmark's shape, CSV, a plain table.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "bench/ceilings.hpp"
#include "bench/row.hpp"
#include "device/session.hpp"

namespace clpv::bench {

/// What a benchmark ran on and what it was made of: Google Benchmark's context keys (date, host_name, num_cpus, load_avg ...) and
/// clpv's: schema, clpv_version, git_describe, host_cpu, platform, device, driver, compute_units, build_options, kernel_hash.
nlohmann::json context_json(const Session& session);

/// {"context": ..., "benchmarks": [row, ...]}; the context with the ceilings: gflops, bandwidths[], launch_ms.
nlohmann::json report_json(const nlohmann::json& context, const Ceilings& ceilings,
                           const std::vector<Row>& rows);

/// A line a row under a line of keys, the same for every row (Google Benchmark's own CSV gives up where rows differ);
/// samples are left to JSON. By RFC 4180.
std::string report_csv(const std::vector<Row>& rows);

/// [{"name", "unit": "ms", "value", "range"}, ...] of the rows that went well, medians and their spread: what actions that
/// keep a history of benchmarks take, smaller being better.
std::string report_github_action(const std::vector<Row>& rows);

/// Name, median, spread, wall time, GFLOP/s, GB/s, share of the ceiling, error.
std::string report_table(const std::vector<Row>& rows);

}  // namespace clpv::bench
