// SPDX-License-Identifier: MIT
// URIs in untrusted files: files in the model's folder, and data.
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

/// Decodes "%20" and the like; empty if malformed.
std::optional<std::string> percent_decoded(std::string_view uri);

/// Returns true for "data:...", in any case (RFC 3986, section 3.1).
bool is_data_uri(std::string_view uri);

/// Bytes of a data URI (RFC 2397): base64, or percent-encoded text. The media type, which may be
/// absent, is not used: the content determines the format. Throws Error(bad_input) for a URI
/// without a comma, and for characters that are not base64.
Bytes decode_data_uri(const std::string& uri, const std::string& file, std::string_view place);

}  // namespace clpv
