// SPDX-License-Identifier: MIT
// Animated cameras and lights of a scene file: `keys`, each with a time and values of some
// quantities.
#pragma once

#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "scene/curve.hpp"
#include "support/json_schema.hpp"
#include "support/named_enum.hpp"

namespace clpv {

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

}  // namespace clpv
