// SPDX-License-Identifier: MIT
// Jobs of the stages that have problems of their own: gathering, propagation, injection, the sweep.
#pragma once

#include <cmath>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "basis/basis.hpp"
#include "basis/transport.hpp"
#include "device/session.hpp"
#include "kernels/shared/grid.h"
#include "options/stage_options.hpp"
#include "pipeline/raster/surface.hpp"
#include "reference/shade.hpp"
#include "scene/sky.hpp"
#include "verify/inputs.hpp"
#include "verify/job.hpp"

namespace clpv::verify {

// Job of stage `gather`: accumulated volumes to the irradiance of every pixel.

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

// Job of stage `propagate`: injected light to accumulated light.

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

// Job of stage `inject`: RSM and G-buffer to light volume and geometry volume.

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
  /// Bits of visibility_masks() of two cascades, of which `grid` is the second; empty: none.
  std::vector<std::uint8_t> occluded = {};
};

Job inject_job(Session& session, const InjectProblem& problem, const Share& share = not_shared);

/// A problem with random surfaces: one of light, or two of blockers, to test merging.
InjectProblem random_injection(Session& session, const std::shared_ptr<const Basis>& basis,
                               const InjectOptions& options, bool light, bool orthographic,
                               RsmFormat format, bool points = false, bool sees = false);

// Job of stages `sweep` and `bounce`: injected light of nested cascades to swept light.

/// Cascades, finest first. Without a sky the border is dark.
struct SweepProblem {
  std::shared_ptr<const Basis> basis;
  Transport transport;
  SweepOptions options;
  std::vector<ClpvGrid> grids;
  std::vector<SharedVolume> light;
  std::vector<SharedVolume> blockers;    ///< read with SweepOptions::blocking
  std::vector<SharedVolume> reflectors;  ///< read with several bounces
  /// Faces of the white furnace; empty: no furnace is swept, as while geometry stands still.
  std::vector<SharedVolume> white = {};
  std::optional<Sky> sky = {};
  float sky_scale = 1;
  std::vector<reference::MappedLight> lights = {};  ///< in SweepOptions::medium
  float medium_scale = 1;
  /// Bits of visibility_masks() for each cascade, for links by sample points; empty: none.
  std::vector<std::vector<std::uint8_t>> occluded = {};
};

Job sweep_job(Session& session, const SweepProblem& problem, const Share& share = not_shared);

/// A problem with random light, blockers and reflectors, and lights in the medium if the options
/// have one.
SweepProblem random_sweep(const std::shared_ptr<const Basis>& basis, const Transport& transport,
                          const SweepOptions& options);

}  // namespace clpv::verify
