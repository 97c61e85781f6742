// SPDX-License-Identifier: MIT
// NumPy's .npy files of float32: for whoever analyses a volume in Python, and for tests.
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <vector>

namespace clpv {

struct NpyArray {
  std::vector<std::size_t> shape;  ///< the last index varies fastest (C order)
  std::vector<float> values;       ///< as many as the shape's product
};

/// Writes version 1.0, little endian. `values` has as many elements as the shape's product. Throws
/// Error(run_time).
void write_npy(const std::filesystem::path& path, std::span<const float> values,
               std::span<const std::size_t> shape);

/// Reads what write_npy writes: version 1.x, '<f4', C order. Throws Error(bad_input) on anything else.
NpyArray read_npy(const std::filesystem::path& path);

}  // namespace clpv
