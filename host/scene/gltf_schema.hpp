// SPDX-License-Identifier: MIT
// What a glTF document may say, as far as the loader reads it: types, ranges, and every index within its
// list.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

namespace clpv {

/// Checks a parsed glTF document, before tinygltf sees it. Afterwards every index, offset, count and
/// enumeration that the loader reads is in range, views lie in their buffers and accessors in their views.
/// Throws Error(bad_input).
void check_gltf(const nlohmann::json& document, const std::string& file);

/// Whether the loader reads that extension.
bool reads_extension(const std::string& name);

}  // namespace clpv
