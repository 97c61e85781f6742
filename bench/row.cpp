// SPDX-License-Identifier: MIT
// Statistics of a row and its JSON.
#include "bench/row.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "support/json_optional.hpp"
#include "times/time_record.hpp"

namespace clpv {
namespace verify {
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Cost, flops, bytes, working_set, reads_per_cell, writes_per_cell,
                                   launches, fills, waits, arguments, written)
}

namespace bench {
namespace {

nlohmann::json text_or_null(const std::string& text) {
  return text.empty() ? nlohmann::json(nullptr) : nlohmann::json(text);
}

/// NaN becomes null, as JSON has no NaN.
nlohmann::json number_or_null(const std::optional<double>& value) {
  return value && *value == *value ? nlohmann::json(*value) : nlohmann::json(nullptr);
}

nlohmann::json problem_json(const Problem& problem) {
  const RenderOptions& o = problem.options;
  return {
      {"basis", o.basis},    {"layout", name_of(o.layout)},       {"storage", name_of(o.storage)},
      {"lobe", lobes_of(o)}, {"transport", name_of(o.transport)}, {"occlusion", o.blocked()},
      {"grid", o.grid},      {"iterations", o.iterations},        {"filtered", problem.filtered}};
}

/// The keys of problem_json with null values, for a row without volumes.
nlohmann::json no_problem_json() {
  nlohmann::json json = problem_json({});
  for (auto& value : json) value = nullptr;
  json["occlusion"] = false;
  return json;
}

}  // namespace

RenderOptions timed_options() {
  RenderOptions options;
  options.transport = TransportKind::sampled;
  options.storage = Storage::float32;
  options.blocking = Blocking::one_sided;
  options.gather = Gathering::all;
  options.gather_offset = usual_gather_offset(options.gather);
  options.blockers = Blockers::none;
  return options;
}

std::string lobes_of(const RenderOptions& options) {
  const bool in_kernel = options.lobe_time == LobeTime::kernel;
  return fmt::format("{}{}", name_of(options.lobe), in_kernel ? "-kernel" : "");
}

double Row::gflops() const {
  return times.median > 0 ? cost.flops / times.median * 1e-6 : 0;
}

double Row::gbps() const {
  return times.median > 0 ? cost.bytes / times.median * 1e-6 : 0;
}

nlohmann::json to_json(const Row& row, int index) {
  nlohmann::json json = {{"name", row.name},
                         {"run_name", row.name},
                         {"run_type", "iteration"},
                         {"family_index", index},
                         {"per_family_instance_index", 0},
                         {"repetitions", row.samples_ms.size()},
                         {"repetition_index", 0},
                         {"threads", 1},
                         {"real_time", row.times.median},
                         {"cpu_time", row.cpu_ms},
                         {"time_unit", "ms"}};
  json.update({{"suite", row.suite},
               {"coefficients",
                row.coefficients > 0 ? nlohmann::json(row.coefficients) : nlohmann::json(nullptr)},
               {"preset", text_or_null(row.preset)},
               {"recompute", text_or_null(row.recompute)}});
  json.update(row.problem ? problem_json(*row.problem) : no_problem_json());
  json.update({{"status", name_of(row.status)},
               {"reason", text_or_null(row.reason)},
               {"timer", row.from_events ? "event" : "wall"},
               {"samples_ms", row.samples_ms},
               {"wall_ms", row.wall_ms},
               {"first_launch_ms", row.first_launch_ms},
               {"build_ms", row.build_ms},
               {"device_bytes", row.device_bytes},
               {"host_bytes", row.host_bytes}});
  TimeRecord record = time_record(row.stage, row.samples_ms);
  if (row.problem) record.cascade = row.problem->cascade;
  json.update(nlohmann::json(record));
  json["p95"] = row.times.p95;
  json.update(nlohmann::json(row.cost));
  json.update({{"gflops", row.gflops()},
               {"gbps", row.gbps()},
               {"ceiling", text_or_null(row.ceiling)},
               {"ceiling_share", row.ceiling_share},
               {"max_rel_error", number_or_null(row.max_rel_error)},
               {"tolerance", row.tolerance},
               {"published_ms", number_or_null(row.published_ms)}});
  return json;
}

}  // namespace bench
}  // namespace clpv
