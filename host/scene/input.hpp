// SPDX-License-Identifier: MIT
// URIs in untrusted files, restricted to the model's folder.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include "support/error.hpp"
#include "support/input_file.hpp"

namespace clpv {

/// Up to 160 bytes of a text on one line, for messages.
std::string excerpt(std::string_view text);

/// Returns the text with its %XX decoded; nothing if one is malformed.
std::optional<std::string> percent_decoded(std::string_view uri);

/// Canonical path of the relative URI `uri` in `file`, percent-decoded, with links resolved.
/// `folder` must be canonical. Throws Error(bad_input) for absolute paths, `..`, links that lead
/// outside `folder`, and all but regular files.
std::filesystem::path resolve_uri(const std::filesystem::path& folder, const std::string& uri,
                                  const std::string& file, std::string_view place);

}  // namespace clpv
