// SPDX-License-Identifier: MIT
// Reading untrusted files: whole, bounded, and only from where a scene may read.
#pragma once

#include <cstdint>
#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "support/error.hpp"

namespace clpv {

using Bytes = std::vector<std::uint8_t>;

/// Text from a file as it may stand in a message: short, on one line.
std::string shown(std::string_view text);

/// A regular file's contents. `place` names who asked for it. Throws Error(bad_input) where it is missing, no
/// regular file, unreadable, or longer than `limit` bytes.
Bytes read_file(const std::filesystem::path& path, std::uint64_t limit, const std::string& file,
                std::string_view place = {});

/// Parses JSON whose length, nesting and number of values are bounded first. Throws Error(bad_input) with line and column of a syntax
/// error.
nlohmann::json parse_json(std::string_view text, const std::string& file);

/// The file that a relative URI of `file` means, percent-decoded, links resolved. `folder` is canonical.
/// Throws Error(bad_input) for whatever leaves `folder`, and what is no regular file.
std::filesystem::path resolve_uri(const std::filesystem::path& folder, const std::string& uri,
                                  const std::string& file, std::string_view place);

}  // namespace clpv
