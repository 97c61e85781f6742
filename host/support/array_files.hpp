// SPDX-License-Identifier: MIT
// Writes arrays of float32 as NumPy .npy.
#pragma once

#include <filesystem>
#include <span>

namespace clpv {

/// Writes a .npy file of version 1.0, little endian, in C order (last index fastest). The product
/// of `shape` equals values.size(). Throws Error(run_time) if the file cannot be written.
void write_npy(const std::filesystem::path& path, std::span<const float> values,
               std::span<const std::size_t> shape);

}  // namespace clpv
