// SPDX-License-Identifier: MIT
// Writes arrays of float32 as NumPy .npy and as VTK image data (.vti) for ParaView.
#pragma once

#include <array>
#include <filesystem>
#include <span>
#include <string>

namespace clpv {

/// Writes a .npy file of version 1.0, little endian, in C order (last index fastest). The product of `shape` equals
/// values.size(). Throws Error(run_time) if the file cannot be written.
void write_npy(const std::filesystem::path& path, std::span<const float> values,
               std::span<const std::size_t> shape);

/// Array of one tuple per cell: values[cell * components + k], cells with x fastest, then y, z.
struct VtiArray {
  std::string name;
  int components = 1;
  std::span<const float> values;
};

/// Regular grid of cells.
struct VtiGrid {
  std::array<int, 3> cells{};       ///< number along x, y, z
  std::array<double, 3> origin{};   ///< lower corner of the grid [m]
  std::array<double, 3> spacing{};  ///< edge lengths of a cell [m]
};

/// Writes VTK ImageData with appended raw float32, little endian. Each array has components x cells values.
/// Throws Error(run_time) if the file cannot be written.
void write_vti(const std::filesystem::path& path, const VtiGrid& grid, std::span<const VtiArray> arrays);

}  // namespace clpv
