// SPDX-License-Identifier: MIT
// Scene files: model, units, cameras, lights, sky and their keys. docs/scenes.md describes the
// format.
#pragma once

#include <filesystem>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "scene/motion.hpp"
#include "scene/scene.hpp"
#include "support/json_schema.hpp"
#include "support/named_enum.hpp"

namespace clpv {

// Animated cameras and lights of a scene file: `keys`, each with a time and values of some
// quantities.

/// Interpolation between keys, with the scene file's names and the values of Interpolation.
enum class KeyInterpolation : unsigned {
  linear,  ///< linear; directions along the great circle
  step,    ///< constant until the next key
  smooth,  ///< cubic splines with continuous velocity, which is 0 at the first and last key
};

template <>
inline constexpr auto kNames<KeyInterpolation> = name_list("linear", "step", "smooth");

/// A list of the scene file (cameras or lights) and the quantities of its entries that may have
/// keys.
struct KeyedList {
  std::string place;  ///< "/cameras"
  /// Rules of the quantities without keys ("/cameras/*/eye"): numbers or vectors.
  std::vector<Rule> quantities;
  std::string direction;  ///< the quantity that is interpolated as a unit vector; may be empty
  std::vector<KeyInterpolation> interpolations;  ///< allowed
};

/// Rules of `keys` and `interpolation` in a list's entries.
std::vector<Rule> key_rules(const KeyedList& list);

/// One entry of a list: its members without keys, and a curve per quantity with keys.
class KeyedEntry {
 public:
  /// `given` must obey the schema. Throws Error(bad_input) for times that do not rise, keys without
  /// quantities, quantities both in the entry and in keys, directions of length 0, and opposite
  /// directions in adjacent keys.
  KeyedEntry(const nlohmann::json& given, const KeyedList& list, const std::string& file,
             const std::string& place);

  bool moves() const { return !tracks_.empty(); }

  /// The entry at a time, without keys: quantities with keys have their values at that time.
  nlohmann::json at(double seconds) const;

 private:
  struct Track {
    std::string quantity;
    bool number, direction;
    Curve curve;
  };
  std::shared_ptr<const nlohmann::json> members_;  ///< without keys
  std::vector<Track> tracks_;
};

struct SceneDescription {
  std::string file;             ///< path from the user, for messages
  std::filesystem::path model;  ///< resolved against the file's folder; empty if absent
  double metres_per_unit = 1;
  std::optional<float> exposure;  ///< [EV]
  std::optional<float> light_scale;
  std::optional<float> cascade_size;  ///< [m]
  std::optional<int> cascades;
  std::shared_ptr<const Sky> sky;    ///< null if absent
  std::filesystem::path sky_map;     ///< its file; empty if absent
  std::optional<ClpvMedium> medium;  ///< without a box: lower and upper are equal
  std::optional<std::vector<KeyedEntry>> cameras, lights;  ///< replace the model's, unless absent

  /// Returns true if a camera or light has keys.
  bool moves() const;
};

/// Cameras and lights of a scene file at a time, in metres; empty if absent in the file.
struct SceneViews {
  std::optional<std::vector<SceneCamera>> cameras;
  std::optional<std::vector<SceneLight>> lights;
};

/// Reads a scene file. Throws Error(bad_input), also for unknown keys.
SceneDescription read_scene_file(const std::filesystem::path& path);

/// Evaluates cameras and lights at a time. Throws Error(bad_input) that names the time.
SceneViews views_at(const SceneDescription& description, double seconds);

}  // namespace clpv
