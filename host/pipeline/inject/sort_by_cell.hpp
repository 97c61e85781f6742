// SPDX-License-Identifier: MIT
// Sorts the texels of a surface by the cell that contains them (kernels/inject/sort_by_cell.cl).
#pragma once

#include <CL/opencl.hpp>
#include <cstddef>

#include "device/kernel.hpp"
#include "device/session.hpp"

namespace clpv {

/// Stable sort of texels by cell. Memory grows to the largest surface so far.
class CellSorter {
 public:
  explicit CellSorter(Session& session);

  /// Allocates memory for surfaces of up to `texels`. Throws Error(run_time) for more than 2^28 of
  /// them.
  void reserve(std::size_t texels);

  /// Input: the cell of each texel, or CLPV_NO_CELL; uint. The caller writes it before sort().
  const Buffer& keys() const { return keys_; }
  /// Sorts the first `texels` keys, each below `cells` or CLPV_NO_CELL.
  void sort(std::size_t texels, std::size_t cells);
  /// Output: uint2 (cell, texel), the first count() of them.
  const Buffer& sorted() const { return sorted_; }
  /// Output: uint, number of texels that have a cell.
  const Buffer& count() const { return count_; }

 private:
  Session& session_;
  Kernel count_runs_, scatter_runs_, count_texels_, scatter_texels_;
  PrefixSum prefix_sum_;
  Buffer keys_, runs_, sorted_, counts_, run_count_, count_;
};

}  // namespace clpv
