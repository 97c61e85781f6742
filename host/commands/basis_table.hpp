// SPDX-License-Identifier: MIT
// What `clpv basis` tells of a basis: a JSON object each, and a table of several.
#pragma once

#include <glm/glm.hpp>
#include <nlohmann/json.hpp>
#include <string>

#include "basis/rotated_lobe.hpp"

namespace clpv {

/// How lobes are made, and along which axis one is looked at.
struct BasisView {
  LobeOptions lobes;
  glm::dvec3 axis;  ///< unit
};

nlohmann::json describe(const Basis& basis, const BasisView& view);

/// A line each; where the objects have "error_over" (error_over(), of a search's aims), that as well.
std::string table_of(const nlohmann::json& bases);

}  // namespace clpv
