// SPDX-License-Identifier: MIT
// Cameras and lights of a scene file that move: `keys`, each a time and what some quantities are then.
#pragma once

#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "scene/curve.hpp"
#include "support/json_schema.hpp"
#include "support/named_enum.hpp"

namespace clpv {

/// How what moves goes from key to key: an Interpolation, by the scene file's names.
enum class KeyInterpolation : unsigned {
  linear,  ///< evenly; directions along the great circle
  step,    ///< not at all, until the next key
  smooth,  ///< by cubic splines without a jump of speed, at rest at the first key and at the last
};

template <>
inline constexpr auto kNames<KeyInterpolation> = name_list("linear", "step", "smooth");

/// The quantities that may move, of an entry of that list.
struct KeyedList {
  std::string place;             ///< "/cameras"
  std::vector<Rule> quantities;  ///< of the entry's own: "/cameras/*/eye" and so on; numbers or vectors
  std::string direction;         ///< the one of them that is a direction, and keeps to the sphere
  std::vector<KeyInterpolation> interpolations;  ///< allowed
};

/// What the schema says of `keys` and `interpolation` in such a list.
std::vector<Rule> key_rules(const KeyedList& list);

/// One entry of a list: its members as given, and the curves of those that keys name.
class KeyedEntry {
 public:
  /// Of a document that obeys the schema. Throws Error(bad_input) for times that do not rise, keys that say nothing,
  /// quantities that stand both beside the keys and in them, and directions that have no length or turn by half a circle.
  KeyedEntry(const nlohmann::json& given, const KeyedList& list, const std::string& file,
             const std::string& place);

  bool moves() const { return !tracks_.empty(); }

  /// The entry as it is at an instant: what keys name has its value of then, and there are no keys.
  nlohmann::json at(double seconds) const;

 private:
  struct Track {
    std::string quantity;
    bool number, direction;
    Curve curve;
  };
  std::shared_ptr<const nlohmann::json> still_;  ///< all else
  std::vector<Track> tracks_;
};

}  // namespace clpv
