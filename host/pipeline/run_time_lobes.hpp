// SPDX-License-Identifier: MIT
// Lobes that propagation makes in its kernel, thirty a cell and step, as the paper does (LobeTime::kernel): slow, and
// the same light as lobes that are constants.
#pragma once

#include <CL/opencl.hpp>
#include <string>

#include "basis/basis.hpp"
#include "basis/transport.hpp"
#include "codegen/transport_source.hpp"
#include "device/session.hpp"
#include "pipeline/lookup_table.hpp"

namespace clpv {

/// What kernels/run_time_lobes.h needs.
class RunTimeLobes {
 public:
  /// Throws Error(usage) for a transport without lobes, and for fluxes that travel, which leave none to the steps; and as
  /// LookupTable does.
  RunTimeLobes(Session& session, const Basis& basis, const Transport& transport, State state,
               TableStorage storage);

  /// Before and after the text of the transport.
  std::string macros() const { return table_.macros() + functions_.macros(kFunctionsTable); }
  const std::string& text() const { return text_; }
  void add_literals(Literals& literals) const;
  /// Whether basis functions are evaluated in the kernel as well: where light is sampled in the faces' centres. Integrals
  /// over faces stay constants.
  bool evaluates() const { return evaluates_; }
  /// The last arguments of a step, after the others.
  void add_to(Kernel& step) const;

 private:
  LookupTable table_, functions_;
  std::string text_;
  std::size_t faces_ = 0;
  bool unit_flux_, evaluates_;
  Buffer normals_;
  Buffer links_;  ///< where light goes through each face, and the face's solid angle
};

}  // namespace clpv
