// SPDX-License-Identifier: MIT
// The paper's look-up tables on the device, as a plain buffer or as a 1-D image of a buffer.
#pragma once

#include <CL/opencl.hpp>
#include <optional>
#include <string>

#include "basis/basis.hpp"
#include "basis/kernel_text.hpp"
#include "basis/rotated_lobe.hpp"
#include "device/kernel.hpp"
#include "device/session.hpp"
#include "options/choices.hpp"

namespace clpv {

/// Contents of a look-up table: lobes or basis functions.
enum class TableUse { lobes, functions };

/// An optional table that is a kernel's last argument, or the second to last of two. Kernels access
/// it by the macros that macros() defines; the names of the macros follow the name of the table:
///   CLPV_AND_TABLE               ", TYPE table" at the end of a parameter list, or nothing
///   CLPV_PASS_TABLE              ", table" at the end of a call, or nothing
///   CLPV_TABLE_READ(table, i)    entry i
class LookupTable {
 public:
  /// Creates no table if `options` disable it or the basis has no centres. Throws Error(usage) for
  /// a size out of range, and Error(device) with the reason for an image that the device cannot
  /// create.
  LookupTable(Session& session, const Basis& basis, const LobeOptions& options,
              TableStorage storage, TableUse use);

  bool exists() const { return values_.has_value(); }
  std::string macros(const TableName& name = {}) const;
  static std::string no_macros(const TableName& name = {});  ///< macros for no table
  /// Sets the last argument of a kernel compiled with macros(); does nothing without a table.
  void add_to(Kernel& kernel) const;

 private:
  std::optional<std::vector<float>> values_;  ///< tables, concatenated
  TableStorage storage_;
  Buffer buffer_;
  cl::Image1DBuffer image_;
};

}  // namespace clpv
