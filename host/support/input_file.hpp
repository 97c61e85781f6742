// SPDX-License-Identifier: MIT
// Reads whole regular files of bounded size. Folders and devices are rejected first, since streams
// open them too.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace clpv {

inline constexpr std::uintmax_t kMaxFileBytes = std::uintmax_t{1}
                                                << 28;  ///< more than any cache or report

/// Returns the bytes of a regular file that clpv may itself have written; nothing if it is missing,
/// unreadable or longer than `limit` bytes.
std::optional<std::string> file_bytes(const std::filesystem::path& path,
                                      std::uintmax_t limit = kMaxFileBytes);

using Bytes = std::vector<std::uint8_t>;

/// Returns the bytes of an input, a regular file, and adds it to the InputRecord. `file` and
/// `place` name the document that refers to it, for errors. Throws Error(bad_input) if it is
/// missing, not a regular file, unreadable or longer than `limit` bytes.
Bytes read_file(const std::filesystem::path& path, std::uint64_t limit, const std::string& file,
                std::string_view place = {});

/// Returns $XDG_CACHE_HOME/clpv, else $HOME/.cache/clpv; nothing if neither is an absolute path.
/// Does not create the folder.
std::optional<std::filesystem::path> user_cache_folder();

}  // namespace clpv
