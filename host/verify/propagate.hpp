// SPDX-License-Identifier: MIT
// Job of stage `propagate`: injected light to accumulated light.
#pragma once

#include <memory>

#include "basis/basis.hpp"
#include "basis/transport.hpp"
#include "device/session.hpp"
#include "options/stage_options.hpp"
#include "verify/job.hpp"

namespace clpv::verify {

struct PropagateProblem {
  std::shared_ptr<const Basis> basis;
  Transport transport;
  PropagateOptions options;
  int steps;
  SharedVolume light;
  SharedVolume geometry;  ///< null: nothing blocks
};

Job propagate_job(Session& session, const PropagateProblem& problem,
                  const Share& share = not_shared);

/// A problem with random light, and random blockers if `blocked`.
PropagateProblem random_propagation(const std::shared_ptr<const Basis>& basis,
                                    const Transport& transport, const PropagateOptions& options,
                                    bool blocked);

}  // namespace clpv::verify
