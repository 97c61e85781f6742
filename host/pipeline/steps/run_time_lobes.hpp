// SPDX-License-Identifier: MIT
// Propagation lobes computed in the kernel, 30 per cell and step, as in the paper
// (LobeTime::kernel). Slow, with the same result as constant lobes.
#pragma once

#include <CL/opencl.hpp>
#include <string>

#include "basis/basis.hpp"
#include "basis/transport.hpp"
#include "device/session.hpp"
#include "pipeline/inject/lookup_table.hpp"

namespace clpv {

/// Arguments and literals for kernels/steps/run_time_lobes.h.
class RunTimeLobes {
 public:
  /// Throws Error(usage) for a transport without lobes. Otherwise throws as LookupTable does.
  RunTimeLobes(Session& session, const Basis& basis, const Transport& transport,
               TableStorage storage);

  /// Source text before and after that of the transport.
  std::string macros() const { return table_.macros() + functions_.macros(kFunctionsTable); }
  const std::string& text() const { return text_; }
  void add_literals(Literals& literals) const;
  /// Sets the last arguments of a step.
  void add_to(Kernel& step) const;

 private:
  LookupTable table_, functions_;
  std::string text_;
  bool unit_flux_;
  bool evaluates_;  ///< the kernel also evaluates basis functions, at face centres; integrals over
                    ///< faces are constants
  Buffer normals_;
  Buffer links_;  ///< direction of the link through each face, and the face's solid angle
};

}  // namespace clpv
