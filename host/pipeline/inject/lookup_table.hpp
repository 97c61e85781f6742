// SPDX-License-Identifier: MIT
// Literals of lobes, and the paper's look-up tables on the device, as a plain buffer or as a 1-D
// image of a buffer.
#pragma once

#include <CL/opencl.hpp>
#include <optional>
#include <vector>

#include "basis/basis.hpp"
#include "basis/rotated_lobe.hpp"
#include "device/kernel.hpp"
#include "device/session.hpp"
#include "options/choices.hpp"
#include "support/literals.hpp"

namespace clpv {

/// Contents of a look-up table: lobes or basis functions.
enum class TableUse { lobes, functions };

/// Number of the part of a table that each member of a family uses.
std::vector<int> parts_of(const Parameters& parameters);

/// An optional table that is a kernel's last argument, or the second to last of two
/// (kernels/basis/table.h).
class LookupTable {
 public:
  /// Creates no table if `options` disable it or the basis has no centres. Throws Error(usage) for
  /// a size out of range, and Error(device) with the reason for an image that the device cannot
  /// create.
  LookupTable(Session& session, const Basis& basis, const LobeOptions& options,
              TableStorage storage, TableUse use);

  bool exists() const { return values_.has_value(); }
  /// Literals of kernels/basis/table.h, the same for both uses; none without a table.
  void add_literals(Literals& literals) const;
  /// Sets the last argument of a kernel; does nothing without a table.
  void add_to(Kernel& kernel) const;

 private:
  std::optional<std::vector<float>> values_;  ///< tables, concatenated
  std::vector<int> function_parts_;
  int size_;  ///< entries of a part
  TableStorage storage_;
  Buffer buffer_;
  cl::Image1DBuffer image_;
};

/// Tables of the basis and of its lobes (kernels/basis/lobe.h). Call add_coefficient_literals() too
/// and, for rotated lobes, LookupTable::add_literals().
Literals lobe_literals(const Basis& basis, const LobeOptions& lobes);

}  // namespace clpv
