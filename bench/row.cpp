// SPDX-License-Identifier: MIT
// Statistics of a row and its JSON.

#include "bench/row.hpp"

#include <fmt/chrono.h>
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <nlohmann/json.hpp>
#include <thread>

#include "bench/git_describe.h"
#include "bench/suites.hpp"
#include "clpv/version.hpp"
#include "device/program.hpp"
#include "support/fingerprint.hpp"
#include "support/json_optional.hpp"
#include "times/time_record.hpp"

namespace clpv::bench {
namespace {

nlohmann::json text_or_null(const std::string& text) {
  return text.empty() ? nlohmann::json(nullptr) : nlohmann::json(text);
}

nlohmann::json problem_json(const Problem& problem) {
  const RenderOptions& o = problem.options;
  return {
      {"basis", o.basis},    {"layout", name_of(o.layout)},       {"storage", name_of(o.storage)},
      {"lobe", lobes_of(o)}, {"transport", name_of(o.transport)}, {"occlusion", o.blocked()},
      {"grid", o.grid},      {"iterations", o.iterations},        {"filtered", problem.filtered}};
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
               {"coefficients", row.coefficients},
               {"preset", text_or_null(row.preset)},
               {"recompute", text_or_null(row.recompute)}});
  json.update(problem_json(row.problem));
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
  record.cascade = row.problem.cascade;
  json.update(nlohmann::json(record));
  json["p95"] = row.times.p95;
  json.update({{"launches", row.host.launches},
               {"fills", row.host.fills},
               {"waits", row.host.waits},
               {"arguments", row.host.arguments},
               {"written", row.host.written},
               {"max_rel_error", row.max_rel_error},
               {"tolerance", row.tolerance},
               {"published_ms", row.published_ms}});
  return json;
}

namespace {

/// The processor's name from /proc/cpuinfo, else "unknown".
std::string host_cpu() {
  std::ifstream file("/proc/cpuinfo");
  for (std::string line; std::getline(file, line);) {
    if (!line.starts_with("model name")) continue;
    const auto at = line.find(": ");
    if (at != std::string::npos) return line.substr(at + 2);
  }
  return "unknown";
}

std::string kernel_hash() {
  Fingerprint fingerprint;
  add_kernels(fingerprint);
  return fingerprint.hex();
}

std::string now() {
  return fmt::format(
      "{:%FT%TZ}",
      fmt::gmtime(std::chrono::system_clock::to_time_t(std::chrono::system_clock::now())));
}

nlohmann::json context_json(const Session& session, const std::string& scene) {
  const Device& device = session.device();
  std::array<char, 256> host{};
  ::gethostname(host.data(), host.size() - 1);
  std::array<double, 3> load{};
  ::getloadavg(load.data(), static_cast<int>(load.size()));
  return {{"schema", 2},
          {"date", now()},
          {"host_name", host.data()},
          {"executable", "clpv"},
          {"num_cpus", std::thread::hardware_concurrency()},
          {"load_avg", load},
          {"library_build_type", "release"},
          {"clpv_version", version()},
          {"git_describe", CLPV_GIT_DESCRIBE},
          {"host_cpu", host_cpu()},
          {"platform", device.platform},
          {"platform_version", device.platform_version},
          {"device", device.name},
          {"driver", device.driver},
          {"compute_units", device.compute_units},
          {"build_options", ProgramSource{}.options},
          {"kernel_hash", kernel_hash()},
          {"scene", scene}};
}

}  // namespace

nlohmann::json report_json(const Session& session, const std::string& scene,
                           const std::vector<Row>& rows) {
  nlohmann::json list = nlohmann::json::array();
  for (std::size_t i = 0; i < rows.size(); ++i)
    list.push_back(to_json(rows[i], static_cast<int>(i)));
  return {{"context", context_json(session, scene)}, {"benchmarks", list}};
}

std::string report_github_action(const std::vector<Row>& rows) {
  nlohmann::json list = nlohmann::json::array();
  for (const Row& row : rows) {
    if (row.status != Status::ok) continue;
    list.push_back({{"name", row.name},
                    {"unit", "ms"},
                    {"value", row.times.median},
                    {"range", fmt::format("{:.4g}", row.times.mad)}});
  }
  return list.dump(2) + "\n";
}

std::string report_table(const std::vector<Row>& rows) {
  const std::size_t width = name_width(rows);
  return fmt::format("{:<{}} {:>10} {:>8} {:>10} {:>9}\n", "row", width, "median ms", "mad",
                     "wall ms", "error") +
         row_lines(rows, width, [](const Row& row) {
           return fmt::format("{:>10.4f} {:>8.4f} {:>10.4f} {:>9}", row.times.median, row.times.mad,
                              row.wall_ms, error_text(row));
         });
}

}  // namespace clpv::bench
