// SPDX-License-Identifier: MIT
#include "bench/report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

namespace clpv::bench {
namespace {

/// A value of CSV, in quotes where it needs them.
std::string csv_field(const nlohmann::json& value) {
  if (value.is_null()) return {};
  std::string text = value.is_string() ? value.get<std::string>() : value.dump();
  if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char c : text) quoted += c == '"' ? "\"\"" : std::string(1, c);
  return quoted + "\"";
}

std::string or_dash(bool there, const std::string& text) {
  return there ? text : "-";
}

}  // namespace

nlohmann::json report_json(const nlohmann::json& context, const Ceilings& ceilings,
                           const std::vector<Row>& rows) {
  nlohmann::json list = nlohmann::json::array(), bandwidths = nlohmann::json::array();
  for (std::size_t i = 0; i < rows.size(); ++i) list.push_back(to_json(rows[i], static_cast<int>(i)));
  for (const Bandwidth& bandwidth : ceilings.bandwidths)
    bandwidths.push_back({{"working_set", bandwidth.working_set}, {"gbps", bandwidth.gbps}});
  nlohmann::json all = context;
  all["ceilings"] = {
      {"gflops", ceilings.gflops}, {"bandwidths", bandwidths}, {"launch_ms", ceilings.launch_ms}};
  return {{"context", all}, {"benchmarks", list}};
}

std::string report_csv(const std::vector<Row>& rows) {
  std::string text;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    nlohmann::json row = to_json(rows[i], static_cast<int>(i));
    row.erase("samples_ms");
    std::vector<std::string> keys, values;
    for (const auto& [key, value] : row.items()) {
      keys.push_back(key);
      values.push_back(csv_field(value));
    }
    if (i == 0) text += fmt::format("{}\r\n", fmt::join(keys, ","));
    text += fmt::format("{}\r\n", fmt::join(values, ","));
  }
  return text;
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
  std::size_t width = 4;
  for (const Row& row : rows) width = std::max(width, row.name.size());
  std::string text = fmt::format("{:<{}} {:>10} {:>8} {:>10} {:>9} {:>8} {:>16} {:>9}\n", "row", width,
                                 "median ms", "mad", "wall ms", "GFLOP/s", "GB/s", "of ceiling", "error");
  for (const Row& row : rows) {
    if (row.status == Status::unsupported || row.status == Status::timed_out) {
      text += fmt::format("{:<{}} {}: {}\n", row.name, width, name_of(row.status), row.reason);
      continue;
    }
    text += fmt::format(
        "{:<{}} {:>10.4f} {:>8.4f} {:>10.4f} {:>9} {:>8} {:>16} {:>9}", row.name, width, row.times.median,
        row.times.mad, row.wall_ms, or_dash(row.cost.flops > 0, fmt::format("{:.1f}", row.gflops())),
        or_dash(row.cost.bytes > 0, fmt::format("{:.1f}", row.gbps())),
        or_dash(!row.ceiling.empty(), fmt::format("{:.0f}% {}", 100 * row.ceiling_share, row.ceiling)),
        or_dash(row.max_rel_error.has_value(), fmt::format("{:.1e}", row.max_rel_error.value_or(0))));
    if (row.status == Status::wrong)
      text += fmt::format("  WRONG, {:.0e} allowed: {}", row.tolerance, row.reason);
    text += "\n";
  }
  return text;
}

}  // namespace clpv::bench
