// SPDX-License-Identifier: MIT
// JSON and URIs of untrusted files: bounded, and only from where a scene may read.
#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>

#include "support/error.hpp"
#include "support/input_file.hpp"

namespace clpv {

/// Text from a file as it may stand in a message: short, on one line.
std::string shown(std::string_view text);

/// Parses JSON whose length, nesting and number of values are bounded first. Throws Error(bad_input) with line and column of a syntax
/// error.
nlohmann::json parse_json(std::string_view text, const std::string& file);

/// The file that a relative URI of `file` means, percent-decoded, links resolved. `folder` is canonical.
/// Throws Error(bad_input) for whatever leaves `folder`, and what is no regular file.
std::filesystem::path resolve_uri(const std::filesystem::path& folder, const std::string& uri,
                                  const std::string& file, std::string_view place);

}  // namespace clpv
