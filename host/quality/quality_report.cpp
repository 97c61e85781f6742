// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <string_view>

#include "options/stages.hpp"
#include "quality/quality.hpp"
#include "support/json_optional.hpp"
#include "support/named_enum.hpp"
#include "times/time_record.hpp"

namespace clpv {
namespace {

nlohmann::json json_of(const Variant& variant) {
  nlohmann::json json = nlohmann::json::object();
  for (const auto& [name, value] : variant) json[name] = value;
  return json;
}

/// Formats lines of equal width: first column left-aligned, others right-aligned.
std::string aligned(const std::vector<std::vector<std::string>>& rows) {
  std::vector<std::size_t> widths(rows[0].size(), 0);
  for (const auto& row : rows) {
    for (std::size_t c = 0; c < row.size(); ++c) widths[c] = std::max(widths[c], row[c].size());
  }
  std::string text;
  for (const auto& row : rows) {
    text += fmt::format("{:<{}}", row[0], widths[0]);
    for (std::size_t c = 1; c < row.size(); ++c) text += fmt::format("  {:>{}}", row[c], widths[c]);
    text += '\n';
  }
  return text;
}

/// Text with so many decimals; '-' if the number is undefined.
std::string text_of(const std::optional<double>& number, int decimals, double factor = 1) {
  return number ? fmt::format("{:.{}f}", factor * *number, decimals) : "-";
}

std::string percent(const std::optional<double>& share) {
  return text_of(share, 1, 100);
}

/// Lines that explain marks of the table: undefined errors, which no mean has, and cached times.
std::string notes_of(const std::vector<QualityCell>& cells) {
  std::string notes;
  if (std::ranges::any_of(cells, &QualityCell::cached))
    notes = "*: measured by an earlier run; --fresh measures all together\n";
  const auto undefined = std::ranges::count_if(
      cells, [](const QualityCell& cell) { return cell.rejected.empty() && !cell.nrmse; });
  if (undefined > 0)
    notes +=
        fmt::format("-: undefined, as over a black ground truth: {} of {} errors, in no mean\n",
                    undefined, cells.size());
  return notes;
}

/// Timed stages of a frame: stages with a pass of their name.
std::vector<std::string_view> timed_stages() {
  std::vector<std::string_view> timed;
  for (const Stage stage : values_of<Stage>()) {
    const auto is_part = [&](Pass pass) { return name_of(pass).starts_with(name_of(stage)); };
    if (std::ranges::any_of(values_of<Pass>(), is_part)) timed.push_back(name_of(stage));
  }
  return timed;
}

/// Time [ms] of all passes of a stage: "rasterize" is rasterize-rsm, rasterize-camera and
/// rasterize-shadow.
double kind_ms(const QualitySummary& sum, std::string_view kind) {
  double ms = 0;
  for (const auto& [stage, value] : sum.stage_ms) ms += stage.starts_with(kind) ? value : 0;
  return ms;
}

}  // namespace

NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(QualityCell, scene, camera, rejected, nrmse, best_gain,
                                   nrmse_best_gain, energy_ratio, flip, times, compute_units,
                                   settings, cached, setup_s, measured_s)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(QualitySummary, views, rejected, cached, undefined, nrmse,
                                   worst_nrmse, nrmse_best_gain, energy_ratio, flip, frame_ms,
                                   stage_ms)

nlohmann::json to_json(const QualityCell& cell) {
  nlohmann::json json = cell, varied = nlohmann::json::array();  // an array: objects lose the order
  for (const auto& [name, value] : cell.variant) varied.push_back({name, value});
  json.update({{"options", json_of(cell.variant)},
               {"varied", varied},
               {"timer", cell.from_events ? "event" : "wall"}});
  return json;
}

QualityCell cell_from_json(const nlohmann::json& json) {
  QualityCell cell = json;
  for (const auto& pair : json.at("varied")) cell.variant.emplace_back(pair.at(0), pair.at(1));
  cell.from_events = json.at("timer") == "event";
  return cell;
}

nlohmann::json to_json(const QualitySummary& sum) {
  nlohmann::json json = sum;
  json["options"] = json_of(sum.variant);
  return json;
}

std::string quality_table(const std::vector<QualityCell>& cells) {
  const std::vector<std::string_view> kinds = timed_stages();
  std::vector<std::pair<std::string, std::string>> views;  // scene, camera
  for (const QualityCell& cell : cells) {
    if (std::pair view{cell.scene, cell.camera}; std::ranges::count(views, view) == 0)
      views.push_back(view);
  }
  std::vector<std::vector<std::string>> rows(1);
  rows[0] = {"NRMSE %"};
  for (const auto& [scene, camera] : views) rows[0].push_back(scene + ":" + camera);
  for (const char* name : {"mean", "worst", "best gain", "energy", "FLIP", "frame ms"})
    rows[0].push_back(name);
  for (const std::string_view kind : kinds) rows[0].emplace_back(kind);
  for (const QualitySummary& sum : summarise(cells)) {
    std::vector<std::string>& row = rows.emplace_back();
    row.push_back(describe(sum.variant));
    for (const auto& [scene, camera] : views) {
      const auto here = [&, s = scene, c = camera](const QualityCell& cell) {
        return cell.scene == s && cell.camera == c && cell.variant == sum.variant;
      };
      const auto cell = std::ranges::find_if(cells, here);
      row.push_back(cell == cells.end()      ? "-"
                    : cell->rejected.empty() ? percent(cell->nrmse)
                                             : "rejected");
    }
    row.resize(rows[0].size(), "-");
    if (sum.rejected == sum.views) continue;
    std::size_t c = 1 + views.size();
    row[c++] = percent(sum.nrmse);
    row[c++] = percent(sum.worst_nrmse);
    row[c++] = percent(sum.nrmse_best_gain);
    row[c++] = text_of(sum.energy_ratio, 2);
    row[c++] = text_of(sum.flip, 3);
    row[c++] = text_of(sum.frame_ms, 1) + (sum.cached > 0 ? "*" : "");
    for (const std::string_view kind : kinds) row[c++] = fmt::format("{:.1f}", kind_ms(sum, kind));
  }
  return aligned(rows) + notes_of(cells);
}

}  // namespace clpv
