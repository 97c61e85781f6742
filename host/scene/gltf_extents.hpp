// SPDX-License-Identifier: MIT
// Whether the parts of a glTF document lie within what holds them: views in buffers, accessors in views.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

namespace clpv {

/// For a document whose types and indices have been checked (gltf_schema.hpp). Throws Error(bad_input).
void check_gltf_extents(const nlohmann::json& document, const std::string& file);

}  // namespace clpv
