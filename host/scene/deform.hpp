// SPDX-License-Identifier: MIT
// Vertices bent by morph targets and by joints.
#pragma once

#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "scene/gltf_primitive.hpp"

namespace clpv {

/// The primitive's vertices, each target added by its weight; normals unit, flat ones by their triangles anew.
std::vector<LocalVertex> morphed(const LocalPrimitive& primitive, std::span<const double> weights);

/// What a vertex goes with: its joints' matrices by their shares.
glm::dmat4 blended(const Influence& influence, std::span<const glm::dmat4> joints);

}  // namespace clpv
