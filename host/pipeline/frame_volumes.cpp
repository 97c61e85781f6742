// SPDX-License-Identifier: MIT
#include "pipeline/frame_volumes.hpp"

#include <algorithm>

#include "basis/bounce.hpp"
#include "basis/sweep.hpp"
#include "options/stage_options.hpp"
#include "pipeline/blockers.hpp"
#include "pipeline/reflectors.hpp"
#include "pipeline/sweep.hpp"
#include "pipeline/visibility.hpp"
#include "support/error.hpp"
#include "volume/accumulator.hpp"

namespace clpv {
namespace {

bool sweeps(const RenderOptions& options) {
  return options.transport == TransportKind::sweep;
}

/// Of what is hidden, in one buffer.
std::size_t sight_bytes(const RenderOptions& options, int grid) {
  return options.gather == Gathering::visible ? CellVisibility::bytes(grid, options.cascades) : 0;
}

/// Bytes of the volumes of a frame at this grid.
double volume_bytes(const RenderOptions& options, const Basis& basis, int grid) {
  RenderOptions tried = options;
  tried.grid = grid;
  const auto bytes = [&](const VolumeShape& shape) {
    return static_cast<double>(stored_bytes(options.format(), shape));
  };
  const VolumeShape lit = light_shape(tried, basis), blocking = geometry_shape(tried, basis),
                    carried{grid, options.state == State::fluxes ? 6 : basis.size(), 3};
  const double masks = options.blockers == Blockers::scene
                           ? static_cast<double>(BlockerVoxelizer::bytes(grid, options.cascades))
                           : 0;
  const double reflecting = options.bounces == Bounces::one
                                ? 0
                                : options.cascades * bytes({grid, kReflectingSides, 3}) +
                                      static_cast<double>(ReflectorVoxelizer::bytes(grid));
  const auto sight = static_cast<double>(sight_bytes(options, grid));
  if (sweeps(options)) {
    return sight + injected_volumes(options) * bytes(lit) +
           options.cascades * bytes({grid, swept_basis()->size(), 3}) +
           geometry_volumes(options) * bytes(blocking) + masks + reflecting +
           Sweeper::bytes(sweep_options(tried));
  }
  // What adding takes besides: steps, and what is carried down, add to light; injection adds to its cells.
  const auto spare = [&](const VolumeShape& shape) {
    return static_cast<double>(Accumulator::spare_bytes(options.format(), shape));
  };
  const auto cells = [&](const VolumeShape& shape) {
    return static_cast<double>(Accumulator::cells_bytes(options.format(), shape));
  };
  return sight + bytes(lit) * (injected_volumes(options) + options.cascades) + 3 * bytes(carried) +
         (1 + geometry_volumes(options)) * bytes(blocking) + masks + 2 * spare(lit) + spare(carried) +
         cells(lit) + cells(blocking);
}

/// Rejects a grid whose volumes exceed the device, naming the largest that fits.
void require_memory(const Session& session, const RenderOptions& options, const Basis& basis) {
  const Device& device = session.device();
  const auto fits = [&](int grid) {
    const std::size_t one = stored_bytes(options.format(), {grid, std::max(6, basis.size()), 3});
    return std::max(one, sight_bytes(options, grid)) <= device.max_alloc_bytes &&
           volume_bytes(options, basis, grid) <= static_cast<double>(device.memory_bytes);
  };
  if (fits(options.grid)) return;
  int grid = options.grid;
  while (grid > 1 && !fits(grid)) --grid;
  throw Error(ExitCode::run_time,
              "grid {}: light volumes of {} need {:.0f} MiB; {} has {} MiB, {} MiB a buffer; the largest "
              "grid that fits is {}",
              options.grid, basis.name(), volume_bytes(options, basis, options.grid) / 1048576, device.name,
              device.memory_bytes >> 20, device.max_alloc_bytes >> 20, grid);
}

/// Rejects what needs a transport by faces.
void require_faces(const RenderOptions& options) {
  if (has_faces(options.transport)) return;
  if (options.state != State::coefficients) {
    throw Error(ExitCode::usage, "state: found '{}' with transport '{}', allowed: coefficients",
                name_of(options.state), name_of(options.transport));
  }
  if (options.lobe_time != LobeTime::host) {
    throw Error(ExitCode::usage,
                "lobe-time: found '{}' with transport '{}', which has no lobes; allowed: host",
                name_of(options.lobe_time), name_of(options.transport));
  }
}

/// Rejects what a transport cannot do, and what the scene's triangles cannot.
void require_compatible(const RenderOptions& options) {
  if (options.occlusion && options.blockers == Blockers::scene && options.blocking != Blocking::areas) {
    throw Error(ExitCode::usage,
                "blocking: found '{}' with blockers 'scene', allowed: areas (or blockers 'seen')",
                name_of(options.blocking));
  }
  if (!sweeps(options) && options.bounces != Bounces::one) {
    throw Error(ExitCode::usage, "bounces: found '{}' with transport '{}', allowed: 1 (or transport 'sweep')",
                name_of(options.bounces), name_of(options.transport));
  }
  require_faces(options);
}

}  // namespace

VolumeShape light_shape(const RenderOptions& options, const Basis& basis) {
  return {options.grid, basis.size(), 3};
}

VolumeShape geometry_shape(const RenderOptions& options, const Basis& basis) {
  return {options.grid + 1, blocking_size(options.blocking, basis), 1};
}

std::unique_ptr<Basis> swept_basis(const RenderOptions& options) {
  return sweeps(options) ? swept_basis() : nullptr;
}

bool blocked_by_view(const RenderOptions& options) {
  return options.occlusion && options.blockers == Blockers::seen;
}

int injected_volumes(const RenderOptions& options) {
  return blocked_by_view(options) ? options.cascades : 1;
}

int geometry_volumes(const RenderOptions& options) {
  if (!options.occlusion) return 0;
  return options.blockers == Blockers::scene ? options.cascades : 1;
}

const RenderOptions& checked(const Session& session, const RenderOptions& options, const Basis& basis) {
  require_compatible(options);
  require_supported(session.device(), options.format(), light_shape(options, basis));
  require_memory(session, options, basis);
  return options;
}

}  // namespace clpv
