// SPDX-License-Identifier: MIT
// Small files read whole, and only where they are files: a folder of that name opens like one, and then throws a
// library's words.
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

inline constexpr std::uintmax_t kMostFileBytes = std::uintmax_t{1}
                                                 << 28;  ///< of caches and reports: far more than any has

/// A regular file's bytes. Nothing where there is none, where it cannot be read, or where it is longer than `most`.
std::optional<std::string> file_bytes(const std::filesystem::path& path,
                                      std::uintmax_t most = kMostFileBytes);

using Bytes = std::vector<std::uint8_t>;

/// A regular file's contents. `place` names who asked for it. Throws Error(bad_input) where it is missing, no
/// regular file, unreadable, or longer than `limit` bytes.
Bytes read_file(const std::filesystem::path& path, std::uint64_t limit, const std::string& file,
                std::string_view place = {});

/// $XDG_CACHE_HOME/clpv, else $HOME/.cache/clpv; nothing where neither variable is set. Not created.
std::optional<std::filesystem::path> user_cache_folder();

/// The four bytes from `at` on, which must be there.
inline std::uint32_t little_endian_word(std::span<const std::uint8_t> bytes, std::size_t at) {
  return bytes[at] | bytes[at + 1] << 8 | bytes[at + 2] << 16 | std::uint32_t{bytes[at + 3]} << 24;
}

}  // namespace clpv
