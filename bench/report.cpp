// SPDX-License-Identifier: MIT
// Writes benchmark results as JSON and tables.
#include "bench/report.hpp"

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
#include "device/kernel_files.hpp"
#include "support/fingerprint.hpp"

namespace clpv::bench {
namespace {

std::string or_dash(bool available, const std::string& text) {
  return available ? text : "-";
}

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

/// Content hash of all kernel files; files in CLPV_KERNEL_DIR replace embedded ones.
std::string kernel_hash() {
  Fingerprint fingerprint;
  for (const auto& [name, text] : detail::embedded_kernel_files())
    fingerprint.add(name).add(kernel_file(name));
  return fingerprint.hex();
}

std::string now() {
  return fmt::format(
      "{:%FT%TZ}",
      fmt::gmtime(std::chrono::system_clock::to_time_t(std::chrono::system_clock::now())));
}

}  // namespace

NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Bandwidth, working_set, gbps)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Ceilings, gflops, bandwidths, launch_ms)

nlohmann::json context_json(const Session& session) {
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
          {"kernel_hash", kernel_hash()}};
}

nlohmann::json report_json(const nlohmann::json& context, const Ceilings& ceilings,
                           const std::vector<Row>& rows) {
  nlohmann::json list = nlohmann::json::array(), with_ceilings = context;
  for (std::size_t i = 0; i < rows.size(); ++i)
    list.push_back(to_json(rows[i], static_cast<int>(i)));
  with_ceilings["ceilings"] = ceilings;
  return {{"context", with_ceilings}, {"benchmarks", list}};
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

namespace {

/// Reasons of rows above 100 % of a ceiling, one line each.
std::string notes_above_ceilings(const std::vector<Row>& rows) {
  static constexpr std::pair<std::string_view, const char*> kReasons[] = {
      {"bandwidth",
       "caches serve some of the counted bytes, or the machine was slower for the ceiling"},
      {"fma",
       "the compiler removes some of the counted operations, or the machine was slower for the "
       "ceiling"},
      {"launch", "the machine was slower for the ceiling"}};
  std::string text;
  for (const auto& [ceiling, reason] : kReasons) {
    const auto above = [&, name = ceiling](const Row& row) {
      return row.ceiling == name && std::round(100 * row.ceiling_share) > 100;
    };
    if (std::ranges::any_of(rows, above))
      text += fmt::format("above 100% {}: {}\n", ceiling, reason);
  }
  return text;
}

}  // namespace

std::string report_table(const std::vector<Row>& rows) {
  const std::size_t width = name_width(rows);
  const std::string head =
      fmt::format("{:<{}} {:>10} {:>8} {:>10} {:>9} {:>8} {:>16} {:>9}\n", "row", width,
                  "median ms", "mad", "wall ms", "GFLOP/s", "GB/s", "of ceiling", "error");
  return head +
         row_lines(rows, width,
                   [](const Row& row) {
                     return fmt::format(
                         "{:>10.4f} {:>8.4f} {:>10.4f} {:>9} {:>8} {:>16} {:>9}", row.times.median,
                         row.times.mad, row.wall_ms,
                         or_dash(row.cost.flops > 0, fmt::format("{:.1f}", row.gflops())),
                         or_dash(row.cost.bytes > 0, fmt::format("{:.1f}", row.gbps())),
                         or_dash(!row.ceiling.empty(),
                                 fmt::format("{:.0f}% {}", 100 * row.ceiling_share, row.ceiling)),
                         error_text(row));
                   }) +
         notes_above_ceilings(rows);
}

}  // namespace clpv::bench
