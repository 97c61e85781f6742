// SPDX-License-Identifier: MIT
// Job of stage `inject`: RSM and G-buffer to light volume and geometry volume.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "basis/basis.hpp"
#include "device/session.hpp"
#include "kernels/shared/grid.h"
#include "options/stage_options.hpp"
#include "pipeline/raster/surface.hpp"
#include "verify/job.hpp"

namespace clpv::verify {

/// A surface on the device, and its host copy.
struct InjectedSurface {
  Surface surface;
  std::shared_ptr<const SurfaceImage> image;  ///< as read_surface() returns it
};

/// Uploads `image` in a format. The host copy is rounded to that format.
InjectedSurface upload_injected(Session& session, const SurfaceImage& image, RsmFormat format,
                                float colour_scale = 1);

struct InjectProblem {
  std::shared_ptr<const Basis> basis;
  InjectOptions options;
  ClpvGrid grid;
  std::optional<InjectedSurface> light;   ///< none: no light volume
  std::vector<InjectedSurface> blockers;  ///< empty: no geometry volume
  int stride = 1;                         ///< stride of the blockers' pixels
  bool on_entries = false;  ///< rounding may decide entries of tables (rounding_decides)
};

Job inject_job(Session& session, const InjectProblem& problem, const Share& share = not_shared);

/// A problem with random surfaces: one of light, or two of blockers, to test merging.
InjectProblem random_injection(Session& session, const std::shared_ptr<const Basis>& basis,
                               const InjectOptions& options, bool light, bool orthographic,
                               RsmFormat format, bool points = false);

}  // namespace clpv::verify
