// SPDX-License-Identifier: MIT
// Arrays of float32 as files: NumPy's .npy, and VTK image data (.vti) for ParaView.
#pragma once

#include <array>
#include <filesystem>
#include <span>
#include <string>

namespace clpv {

/// Writes a .npy of version 1.0, little endian, in C order: the last index varies fastest. `values` has as many elements as
/// the shape's product. Throws Error(run_time).
void write_npy(const std::filesystem::path& path, std::span<const float> values,
               std::span<const std::size_t> shape);

/// One array of values, one tuple a cell: values[cell * components + k], cells with x varying fastest, then
/// y, z.
struct VtiArray {
  std::string name;
  int components = 1;
  std::span<const float> values;
};

struct VtiGrid {
  std::array<int, 3> cells{};       ///< along x, y, z
  std::array<double, 3> origin{};   ///< the grid's lower corner [m]
  std::array<double, 3> spacing{};  ///< a cell's edges [m]
};

/// Writes ImageData with appended raw float32, little endian. Each array has components x cells values.
/// Throws Error(run_time) where the file cannot be written.
void write_vti(const std::filesystem::path& path, const VtiGrid& grid, std::span<const VtiArray> arrays);

}  // namespace clpv
