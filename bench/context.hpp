// SPDX-License-Identifier: MIT
// What a benchmark ran on and what it was made of.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "device/session.hpp"

namespace clpv::bench {

/// Google Benchmark's context keys (date, host_name, num_cpus, caches, load_avg ...) and clpv's: schema, clpv_version,
/// git_describe, host_cpu, platform, device, driver, compute_units, build_options, kernel_hash.
nlohmann::json context_json(const Session& session);

}  // namespace clpv::bench
