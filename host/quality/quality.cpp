// SPDX-License-Identifier: MIT
#include "quality/quality.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <tuple>

#include "device/result_keys.hpp"
#include "image/compare.hpp"
#include "support/error.hpp"
#include "support/fingerprint.hpp"
#include "support/log.hpp"
#include "times/frame_times.hpp"

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

namespace {

constexpr const char* kFingerprint = "fingerprint";  // hash of a cached cell's other values

std::string fingerprint_of(const nlohmann::json& cell) {
  return Fingerprint().add(cell.dump()).hex();
}

}  // namespace

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
  const auto kept = folder_.read(name);
  if (!kept) return std::nullopt;
  try {
    nlohmann::json json = nlohmann::json::parse(*kept);
    const std::string found = json.at(kFingerprint);
    json.erase(kFingerprint);
    if (found == fingerprint_of(json)) return cell_from_json(json);
    log_warning("{}: damaged; measured again", (folder_.path() / name).string());
  } catch (const nlohmann::json::exception& error) {
    log_warning("{}: {}; measured again", (folder_.path() / name).string(), error.what());
  }
  return std::nullopt;
}

void QualityStore::keep(const std::string& key, const QualityCell& cell) {
  if (!writable_) return;
  nlohmann::json json = to_json(cell);
  json[kFingerprint] = fingerprint_of(json);
  warn_of(folder_.write(key + ".json", json.dump(2) + "\n"));
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

}  // namespace clpv
