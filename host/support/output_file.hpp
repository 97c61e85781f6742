// SPDX-License-Identifier: MIT
// Output that is whole or not there: written beside its place, then renamed into it.
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string_view>

namespace clpv {

/// Finds out before the work whether `path` can be written: its folder exists and takes a new file, and what
/// may stand there already is a regular file that may be written. Leaves nothing behind.
/// Throws Error(run_time) that names the path and the reason.
void check_writable(const std::filesystem::path& path);

/// Puts `bytes` at `path`, through a temporary file in the same folder: whoever reads `path` sees the old
/// file or the new one, never a part. On failure (a full disk, say) the temporary file is removed, `path`
/// stays as it was, and Error(run_time) tells why. A symbolic link stays one; its target is replaced.
void write_file(const std::filesystem::path& path, std::span<const std::byte> bytes);
void write_file(const std::filesystem::path& path, std::string_view text);

}  // namespace clpv
