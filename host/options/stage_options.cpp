// SPDX-License-Identifier: MIT
#include "options/stage_options.hpp"

#include "options/render_options.hpp"

namespace clpv {

InjectOptions inject_options(const RenderOptions& options, bool unit_flux_lobes) {
  return {.grid = options.grid,
          .blocking = options.blocking,
          .unit_flux_lobes = unit_flux_lobes,
          .in_front = !has_faces(options.transport),
          .lobes = options.lobes(),
          .table = options.table(),
          .format = options.format()};
}

PropagateOptions propagate_options(const RenderOptions& options) {
  return {.grid = options.grid,
          .lobe_time = options.lobe_time,
          .table = options.table(),
          .format = options.format()};
}

SweepOptions sweep_options(const RenderOptions& options) {
  std::vector<int> parts(static_cast<std::size_t>(options.cascades),
                         parts_of(options.coarser_directions));
  parts.front() = parts_of(options.directions);
  return {.grid = options.grid,
          .parts = parts,
          .blocking = options.blocked(),
          .most_white = options.blockers == Blockers::scene ? kNoLimitOfWhite : 1,
          .bounces = options.reflects() ? options.bounces : Bounces::one,
          .bounce_sweeps = options.bounce_sweeps,
          .format = options.format()};
}

GatherOptions gather_options(const RenderOptions& options, bool medium) {
  return {.grid = options.grid,
          .gather = options.gather,
          .gather_offset = options.gather_offset,
          .lobes = options.lobes(),
          .table = options.table(),
          .format = options.format(),
          .packed = options.traces_near() || medium};
}

namespace {

/// Pixels of the camera per traced pixel, along each axis.
int near_step(const RenderOptions& options) {
  constexpr double kWanted = 240 * 135;
  int step = 1;
  switch (options.near_size) {
    case NearSize::automatic:  // between half and twice as many
      while (step < 8 && double{1} * options.width * options.height > 2 * kWanted * step * step)
        step *= 2;
      return step;
    case NearSize::full:
      return 1;
    case NearSize::half:
      return 2;
    case NearSize::quarter:
      return 4;
    case NearSize::eighth:
      return 8;
  }
  return step;
}

}  // namespace

NearOptions near_options(const RenderOptions& options) {
  constexpr int kRays[] = {2, 4, 8, 16, 64};
  return {.gather = gather_options(options),
          .step = near_step(options),
          .rays = kRays[static_cast<int>(options.near_rays)],
          .reflects = options.reflects()};
}

MediumOptions medium_options(const RenderOptions& options) {
  return {.gather = gather_options(options, true)};
}

}  // namespace clpv
