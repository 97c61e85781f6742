// SPDX-License-Identifier: MIT
#include "quality/quality.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <string_view>
#include <tuple>

#include "device/result_keys.hpp"
#include "image/compare.hpp"
#include "options/stages.hpp"
#include "support/error.hpp"
#include "support/fingerprint.hpp"
#include "support/json_optional.hpp"
#include "support/log.hpp"
#include "support/named_enum.hpp"
#include "times/frame_times.hpp"
#include "times/time_record.hpp"

namespace clpv {
namespace {

std::vector<std::string> split(const std::string& text, char separator) {
  std::vector<std::string> parts(1);
  for (const char c : text) {
    if (c == separator) {
      parts.emplace_back();
    } else {
      parts.back() += c;
    }
  }
  return parts;
}

}  // namespace

void fill_errors(QualityCell& cell, const Image& image, const GroundTruth& truth, Show show) {
  const Image layer = extract_layer(truth.image, std::string(name_of(show)), truth.file.string());
  const Comparison c =
      compare(image, "the rendered frame", layer, truth.file.string(), truth.exposure);
  cell.nrmse = c.nrmse_valid;
  cell.best_gain = c.best_gain;
  cell.nrmse_best_gain = c.nrmse_best_gain;
  cell.energy_ratio = c.energy_ratio;
  cell.flip = c.flip;
}

VariedOption parse_varied(const std::string& text) {
  const auto equals = text.find('=');
  if (equals == std::string::npos)
    throw Error(ExitCode::usage, "vary: found '{}', allowed: OPTION=a,b,c", text);
  VariedOption varied{text.substr(0, equals), {}};
  for (const std::string& value : split(text.substr(equals + 1), ',')) {
    RenderOptions probe;
    set_option(probe, varied.name, value);  // throws for an unknown option or a bad value
    if (std::ranges::count(varied.values, value) > 0) {
      throw Error(ExitCode::usage, "vary {}: duplicate value {}", text, value);
    }
    varied.values.push_back(value);
  }
  return varied;
}

std::vector<Variant> combinations(const std::vector<VariedOption>& varied) {
  std::vector<Variant> all(1);
  for (const VariedOption& option : varied) {
    const auto same = [&](const VariedOption& other) { return other.name == option.name; };
    if (std::ranges::count_if(varied, same) > 1) {
      throw Error(ExitCode::usage, "vary {}: duplicate option", option.name);
    }
    std::vector<Variant> longer;
    for (const Variant& variant : all) {
      for (const std::string& value : option.values) {
        longer.push_back(variant);
        longer.back().emplace_back(option.name, value);
      }
    }
    all = std::move(longer);
  }
  return all;
}

std::string describe(const Variant& variant) {
  std::string text;
  for (const auto& [name, value] : variant)
    text += fmt::format("{}{}={}", text.empty() ? "" : " ", name, value);
  return text;
}

QualityCell measure(Session& session, Frame& frame, const SceneCamera& camera,
                    const GroundTruth& truth, Show show, int frames) {
  Image image;
  const FrameTimes times =
      measure_frames(session, frame, camera, frames, 1, [&] { image = view_image(frame, show); });
  QualityCell cell;
  cell.compute_units = session.device().compute_units;
  cell.from_events = times.from_events();
  cell.times = times.pass_records();
  cell.times.insert(cell.times.begin(), time_record("frame", times.sums()));
  fill_errors(cell, image, truth, show);
  return cell;
}

std::string quality_key(const GroundTruth& truth, const Device& device,
                        const RenderOptions& options, Show show, int frames, int processors) {
  Fingerprint print;
  print.add(times_key(device, options, processors));
  print.add(truth.file.filename().string());  // a name for scene, lights and camera
  add_pixels(print, truth.image);
  return print.add(name_of(show)).add(frames).add(truth.exposure).hex();
}

QualityStore::QualityStore(std::filesystem::path folder) : folder_(std::move(folder)) {
  warn_of(folder_.problem());
}

void QualityStore::warn_of(const std::string& problem) {
  if (problem.empty()) return;
  writable_ = false;
  log_warning("{}: results are not cached", problem);
}

std::optional<QualityCell> QualityStore::find(const std::string& key) const {
  const std::string name = key + ".json";
  const auto kept = folder_.read_checked(name);
  if (!kept) return std::nullopt;
  try {
    return cell_from_json(nlohmann::json::parse(*kept));
  } catch (const nlohmann::json::exception& error) {
    log_warning("{}: {}; measured again", (folder_.path() / name).string(), error.what());
    return std::nullopt;
  }
}

void QualityStore::keep(const std::string& key, const QualityCell& cell) {
  if (!writable_) return;
  warn_of(folder_.write_checked(key + ".json", to_json(cell).dump(2) + "\n"));
}

namespace {

/// Mean of the values that are defined.
template <typename Value>
std::optional<double> mean_of(const std::vector<const QualityCell*>& cells, Value value) {
  double sum = 0;
  int count = 0;
  for (const QualityCell* cell : cells) {
    const std::optional<double> defined = value(*cell);
    sum += defined.value_or(0);
    count += defined.has_value();
  }
  return count > 0 ? std::optional(sum / count) : std::nullopt;
}

QualitySummary summary_of(const Variant& variant, const std::vector<QualityCell>& cells) {
  QualitySummary sum;
  sum.variant = variant;
  std::vector<const QualityCell*> rendered;
  for (const QualityCell& cell : cells) {
    if (cell.variant != variant) continue;
    ++sum.views;
    if (cell.rejected.empty()) rendered.push_back(&cell);
  }
  sum.rejected = sum.views - static_cast<int>(rendered.size());
  for (const QualityCell* cell : rendered) {
    sum.undefined += !cell->nrmse;
    sum.cached += cell->cached;
    sum.worst_nrmse = std::max(sum.worst_nrmse, cell->nrmse);  // an empty one is the least
    for (const TimeRecord& time : cell->times)
      sum.stage_ms[time.stage] += time.median / static_cast<double>(rendered.size());
  }
  const auto mean = [&](auto member) {
    return mean_of(rendered, [member](const QualityCell& cell) { return cell.*member; });
  };
  sum.nrmse = mean(&QualityCell::nrmse);
  sum.nrmse_best_gain = mean(&QualityCell::nrmse_best_gain);
  sum.energy_ratio = mean(&QualityCell::energy_ratio);
  sum.flip = mean(&QualityCell::flip);
  if (const auto frame = sum.stage_ms.extract("frame")) sum.frame_ms = frame.mapped();
  return sum;
}

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

std::vector<QualitySummary> summarise(const std::vector<QualityCell>& cells) {
  std::vector<QualitySummary> sums;
  for (const QualityCell& cell : cells) {
    if (std::ranges::find(sums, cell.variant, &QualitySummary::variant) == sums.end())
      sums.push_back(summary_of(cell.variant, cells));
  }
  std::ranges::stable_sort(sums, {}, [](const QualitySummary& sum) {
    return std::tuple(sum.rejected > 0, sum.undefined, sum.nrmse.value_or(0));
  });
  return sums;
}

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
