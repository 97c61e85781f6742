// SPDX-License-Identifier: MIT
#include "options/stage_options.hpp"

#include "options/render_options.hpp"

namespace clpv {

InjectOptions inject_options(const RenderOptions& options, bool unit_flux_lobes) {
  return {.grid = options.grid,
          .blocking = options.blocking,
          .unit_flux_lobes = unit_flux_lobes,
          .lobes = options.lobes(),
          .table = options.table(),
          .format = options.format()};
}

PropagateOptions propagate_options(const RenderOptions& options) {
  return {.grid = options.grid,
          .state = options.state,
          .lobe_time = options.lobe_time,
          .table = options.table(),
          .format = options.format()};
}

SweepOptions sweep_options(const RenderOptions& options) {
  std::vector<int> parts(static_cast<std::size_t>(options.cascades), parts_of(options.coarser_directions));
  parts.front() = parts_of(options.directions);
  return {.grid = options.grid,
          .parts = parts,
          .blocking = options.blocked(),
          .bounces = options.bounces,
          .format = options.format()};
}

GatherOptions gather_options(const RenderOptions& options, bool medium) {
  return {.grid = options.grid,
          .gather = options.gather,
          .gather_offset = options.gather_offset,
          .lobes = options.lobes(),
          .table = options.table(),
          .format = options.format(),
          .packed = options.near != Near::off || medium};
}

NearOptions near_options(const RenderOptions& options) {
  return {.gather = gather_options(options),
          .step = options.near_size == NearSize::half ? 2 : 1,
          .rays = options.near_size == NearSize::half ? 4 : 2,
          .reflects = options.bounces != Bounces::one};
}

MediumOptions medium_options(const RenderOptions& options) {
  return {.gather = gather_options(options, true)};
}

}  // namespace clpv
