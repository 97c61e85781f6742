// SPDX-License-Identifier: MIT
// Writes arrays as NumPy .npy, and several as .npz.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace clpv {

/// Writes a .npy file of version 1.0, little endian, in C order (last index fastest). The product
/// of `shape` equals values.size(). Throws Error(run_time) if the file cannot be written.
void write_npy(const std::filesystem::path& path, std::span<const float> values,
               std::span<const std::size_t> shape);

/// Bytes of a .npy file: float32, or a text without a shape, of ASCII characters.
std::string npy_bytes(std::span<const float> values, std::span<const std::size_t> shape);
std::string npy_bytes(const std::string& text);

/// Bytes of a .npz file, a ZIP archive without compression, of .npy files by array name. All
/// together at most 2 GiB.
std::string npz_bytes(const std::vector<std::pair<std::string, std::string>>& arrays);

}  // namespace clpv
