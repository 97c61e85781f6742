// SPDX-License-Identifier: MIT
// Atomic file output: a temporary file in the same folder, renamed into place.
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string_view>

namespace clpv {

/// Checks before long work that `path` can be written: its folder exists and accepts a new file, and any existing
/// file is regular and writable. Leaves no file behind. Throws Error(run_time) with the path and the reason.
void check_writable(const std::filesystem::path& path);

/// Writes `bytes` to `path` through a temporary file in the same folder: readers see the old or the new file, never
/// a partial one. On failure (for example a full disk) removes the temporary file, leaves `path` unchanged and throws
/// Error(run_time) with the reason. A symbolic link is kept; its target is replaced.
void write_file(const std::filesystem::path& path, std::span<const std::byte> bytes);
void write_file(const std::filesystem::path& path, std::string_view text);

}  // namespace clpv
