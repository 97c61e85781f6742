// SPDX-License-Identifier: MIT
// URIs of untrusted files: only from where a scene may read.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "support/error.hpp"
#include "support/input_file.hpp"

namespace clpv {

/// Text from a file as it may stand in a message: short, on one line.
std::string shown(std::string_view text);

/// The file that a relative URI of `file` means, percent-decoded, links resolved. `folder` is canonical.
/// Throws Error(bad_input) for whatever leaves `folder`, and what is no regular file.
std::filesystem::path resolve_uri(const std::filesystem::path& folder, const std::string& uri,
                                  const std::string& file, std::string_view place);

}  // namespace clpv
