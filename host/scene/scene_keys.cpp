// SPDX-License-Identifier: MIT
// Reads the keys of cameras and lights, and evaluates them.
#include <fmt/ranges.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "scene/bounds.hpp"
#include "scene/scene_file.hpp"
#include "support/error.hpp"
#include "support/named_enum.hpp"

namespace clpv {
namespace {

using nlohmann::json;

constexpr double kMinDirection = 1e-6;  // shorter directions are rejected

std::string quantity_of(const Rule& rule) {
  return rule.place.substr(rule.place.rfind('/') + 1);
}

void check_key_times(const json& keys, const std::string& file, const std::string& place) {
  for (std::size_t i = 1; i < keys.size(); ++i) {
    const double before = keys[i - 1]["time"], time = keys[i]["time"];
    if (time <= before) {
      reject(file, fmt::format("{}/keys/{}/time", place, i), fmt::format("{} s", time),
             fmt::format("more than the {} s of the key before", before));
    }
  }
}

/// Checks that each key has quantities, and none that the entry has too.
void check_key_quantities(const json& given, const KeyedList& list, const std::string& file,
                          const std::string& place) {
  const json& keys = given["keys"];
  for (std::size_t i = 0; i < keys.size(); ++i) {
    const std::string here = fmt::format("{}/keys/{}", place, i);
    if (keys[i].size() == 1) {
      std::vector<std::string> names;
      for (const Rule& rule : list.quantities) names.push_back(quantity_of(rule));
      reject(file, here, "only a time",
             fmt::format("a time and at least one of {}", fmt::join(names, ", ")));
    }
    for (const auto& [key, value] : keys[i].items()) {
      if (given.contains(key)) {
        reject(file, pointer_to(here, key),
               fmt::format("a duplicate of {}", pointer_to(place, key)), "one of the two");
      }
    }
  }
}

/// Values with tangents: those of the parabola through a key and its neighbours, and 0 at the first
/// and last key.
std::vector<double> with_tangents(const Curve& linear) {
  const std::size_t n = linear.components, keys = linear.times.size();
  std::vector<double> values;
  for (std::size_t k = 0; k < keys; ++k) {
    std::vector<double> tangent(n, 0.0);
    for (std::size_t i = 0; k > 0 && k + 1 < keys && i < n; ++i) {
      const double before = linear.times[k] - linear.times[k - 1],
                   after = linear.times[k + 1] - linear.times[k];
      const double slope_before =
                       (linear.values[k * n + i] - linear.values[(k - 1) * n + i]) / before,
                   slope_after =
                       (linear.values[(k + 1) * n + i] - linear.values[k * n + i]) / after;
      tangent[i] = (slope_before * after + slope_after * before) / (before + after);
    }
    values.insert(values.end(), tangent.begin(), tangent.end());
    const auto value = linear.values.begin() + static_cast<std::ptrdiff_t>(k * n);
    values.insert(values.end(), value, value + static_cast<std::ptrdiff_t>(n));
    values.insert(values.end(), tangent.begin(), tangent.end());
  }
  return values;
}

/// Appends a value as unit vector. Rejects length 0 and the opposite of the previous key.
void add_direction(Curve& curve, const glm::dvec3& value, const std::string& file,
                   const std::string& place) {
  if (glm::length(value) < kMinDirection)
    reject(file, place, "a vector of no length", "a direction");
  const glm::dvec3 unit = glm::normalize(value);
  if (!curve.values.empty()) {
    const double* last = &curve.values[curve.values.size() - 3];
    if (glm::length(glm::dvec3(last[0], last[1], last[2]) + unit) < kMinDirection) {
      reject(file, place, "the opposite of the key before", "a turn by less than half a circle");
    }
  }
  for (int i = 0; i < 3; ++i) curve.values.push_back(unit[i]);
}

Curve read_curve(const json& keys, const std::string& quantity, bool direction,
                 const std::string& file, const std::string& place) {
  Curve curve;
  for (std::size_t i = 0; i < keys.size(); ++i) {
    const auto found = keys[i].find(quantity);
    if (found == keys[i].end()) continue;
    curve.times.push_back(keys[i]["time"]);
    if (direction) {
      add_direction(
          curve, {(*found)[0].get<double>(), (*found)[1].get<double>(), (*found)[2].get<double>()},
          file, pointer_to(fmt::format("{}/keys/{}", place, i), quantity));
    } else if (found->is_number()) {
      curve.values.push_back(*found);
    } else {
      for (const json& number : *found) curve.values.push_back(number);
    }
  }
  if (!curve.times.empty()) curve.components = curve.values.size() / curve.times.size();
  return curve;
}

}  // namespace

std::vector<Rule> key_rules(const KeyedList& list) {
  const std::string keys = list.place + "/*/keys";
  std::vector<std::string> names;
  for (const KeyInterpolation each : list.interpolations) names.emplace_back(name_of(each));
  std::vector<Rule> rules = {rule::list(keys, 1, bounds::kSceneKeys), rule::object(keys + "/*"),
                             rule::number(keys + "/*/time", 0, bounds::kSeconds).must(),
                             rule::text(list.place + "/*/interpolation", names)};
  for (Rule quantity : list.quantities) {
    quantity.place = keys + "/*/" + quantity_of(quantity);
    rules.push_back(std::move(quantity));
  }
  return rules;
}

KeyedEntry::KeyedEntry(const json& given, const KeyedList& list, const std::string& file,
                       const std::string& place) {
  json members = given;
  members.erase("keys");
  members.erase("interpolation");
  members_ = std::make_shared<const json>(std::move(members));
  if (!given.contains("keys")) {
    if (given.contains("interpolation"))
      reject(file, place + "/interpolation", "no keys in the entry", "interpolation with keys");
    return;
  }
  check_key_times(given["keys"], file, place);
  check_key_quantities(given, list, file, place);
  const auto interpolation =
      named<KeyInterpolation>("interpolation", given.value("interpolation", std::string("linear")));
  for (const Rule& quantity : list.quantities) {
    Track track{quantity_of(quantity),
                quantity.shape == Shape::number,
                quantity_of(quantity) == list.direction,
                {}};
    track.curve = read_curve(given["keys"], track.quantity, track.direction, file, place);
    if (track.curve.times.empty()) continue;
    if (interpolation == KeyInterpolation::smooth) track.curve.values = with_tangents(track.curve);
    track.curve.interpolation = static_cast<Interpolation>(interpolation);
    tracks_.push_back(std::move(track));
  }
}

json KeyedEntry::at(double seconds) const {
  json made = *members_;
  for (const Track& track : tracks_) {
    std::vector<double> value(track.curve.components);
    evaluate(track.curve, seconds, value);
    if (track.direction) {
      const glm::dvec3 direction = direction_at(track.curve, seconds);
      value = {direction.x, direction.y, direction.z};
    }
    made[track.quantity] = track.number ? json(value[0]) : json(value);
  }
  return made;
}

}  // namespace clpv
