// SPDX-License-Identifier: MIT
// The paper's look-up tables on the device: as a plain buffer, or as a 1-D image of a buffer.
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

/// Which table a kernel looks things up in, if any.
enum class TableUse { lobes, functions };

/// A table, or none, as a kernel's last argument, or the last but one of two. Kernels take it by the macros that macros()
/// defines, for other names of tables accordingly:
///   CLPV_AND_TABLE               ", TYPE table" at the end of a parameter list, or nothing
///   CLPV_PASS_TABLE              ", table" at the end of a call, or nothing
///   CLPV_TABLE_READ(table, i)    entry i
class LookupTable {
 public:
  /// None, if `options` ask for none or the basis has no centres. Throws Error(usage) for a size out of range, and
  /// Error(device) for an image that the device cannot make, with the reason.
  LookupTable(Session& session, const Basis& basis, const LobeOptions& options, TableStorage storage,
              TableUse use);

  bool exists() const { return values_.has_value(); }
  std::string macros(const TableName& name = {}) const;
  static std::string no_macros(const TableName& name = {});  ///< those of none
  /// The last argument of a kernel that was compiled with macros(), after the others; nothing where there is no table.
  void add_to(Kernel& kernel) const;

 private:
  std::optional<std::vector<float>> values_;  ///< tables one after the other
  TableStorage storage_;
  Buffer buffer_;
  cl::Image1DBuffer image_;
};

}  // namespace clpv
