// SPDX-License-Identifier: MIT
// Propagation lobes computed in the kernel, 30 per cell and step, as in the paper
// (LobeTime::kernel). Slow, with the same result as constant lobes.
#pragma once

#include <CL/opencl.hpp>

#include "basis/basis.hpp"
#include "basis/transport.hpp"
#include "device/session.hpp"
#include "pipeline/inject/lookup_table.hpp"

namespace clpv {

/// Arguments and literals for kernels/steps/propagate_lobes.cl.
class RunTimeLobes {
 public:
  /// Throws Error(usage) for a transport without lobes. Otherwise throws as LookupTable does.
  RunTimeLobes(Session& session, const Basis& basis, const Transport& transport,
               TableStorage storage);

  const Literals& literals() const { return literals_; }
  /// Sets the last arguments of a step.
  void add_to(Kernel& step) const;

 private:
  LookupTable table_, functions_;
  Literals literals_;
  Buffer normals_;
  Buffer links_;  ///< direction of the link through each face, and the face's solid angle
};

}  // namespace clpv
