// SPDX-License-Identifier: MIT
// Job of stage `gather`: accumulated volumes to the irradiance of every pixel.
#pragma once

#include <memory>

#include "basis/basis.hpp"
#include "basis/transport.hpp"
#include "device/session.hpp"
#include "options/stage_options.hpp"
#include "pipeline/raster/surface.hpp"
#include "verify/inputs.hpp"
#include "verify/job.hpp"

namespace clpv::verify {

struct GatherProblem {
  std::shared_ptr<const Basis> basis;
  TransportKind transport;
  GatherOptions options;
  CascadeLight cascades;
  Surface camera = {};
  std::shared_ptr<const SurfaceImage> image = {};  ///< image of `camera`
  std::size_t every = 1;                           ///< compares every `every`-th pixel
};

Job gather_job(Session& session, const GatherProblem& problem, const Share& share = not_shared);

/// A problem with random light and surfaces.
GatherProblem random_gathering(Session& session, const std::shared_ptr<const Basis>& basis,
                               TransportKind transport, const GatherOptions& options);

}  // namespace clpv::verify
