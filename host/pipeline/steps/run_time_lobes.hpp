// SPDX-License-Identifier: MIT
// Propagation lobes computed in the kernel, 30 per cell and step, as in the paper (LobeTime::kernel). Slow, with the
// same result as constant lobes.
#pragma once

#include <CL/opencl.hpp>
#include <string>

#include "basis/basis.hpp"
#include "basis/transport.hpp"
#include "codegen/transport_source.hpp"
#include "device/session.hpp"
#include "pipeline/inject/lookup_table.hpp"

namespace clpv {

/// Arguments and literals for kernels/steps/run_time_lobes.h.
class RunTimeLobes {
 public:
  /// Throws Error(usage) for a transport without lobes, or one that propagates fluxes. Otherwise throws as LookupTable
  /// does.
  RunTimeLobes(Session& session, const Basis& basis, const Transport& transport, State state,
               TableStorage storage);

  /// Source text before and after that of the transport.
  std::string macros() const { return table_.macros() + functions_.macros(kFunctionsTable); }
  const std::string& text() const { return text_; }
  void add_literals(Literals& literals) const;
  /// Returns true if the kernel also evaluates basis functions, to sample light at face centres. Integrals over
  /// faces remain constants.
  bool evaluates() const { return evaluates_; }
  /// Sets the last arguments of a step.
  void add_to(Kernel& step) const;

 private:
  LookupTable table_, functions_;
  std::string text_;
  std::size_t faces_ = 0;
  bool unit_flux_, evaluates_;
  Buffer normals_;
  Buffer links_;  ///< direction of the link through each face, and the face's solid angle
};

}  // namespace clpv
