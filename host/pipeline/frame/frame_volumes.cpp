// SPDX-License-Identifier: MIT
#include "pipeline/frame/frame_volumes.hpp"

#include "basis/sweep.hpp"
#include "support/error.hpp"

namespace clpv {
namespace {

bool sweeps(const RenderOptions& options) {
  return options.transport == TransportKind::sweep;
}

/// Rejects options that a transport without faces does not support.
void require_faces(const RenderOptions& options) {
  if (has_faces(options.transport)) return;
  if (options.state != State::coefficients) {
    throw Error(ExitCode::usage, "state: found '{}'{} with transport '{}', allowed: coefficients",
                name_of(options.state), preset_note(options, "state"), name_of(options.transport));
  }
  if (options.lobe_time != LobeTime::host) {
    throw Error(ExitCode::usage,
                "lobe-time: found '{}'{} with transport '{}', which has no lobes; allowed: host",
                name_of(options.lobe_time), preset_note(options, "lobe-time"), name_of(options.transport));
  }
}

/// Rejects options that the transport or scene blockers do not support.
void require_compatible(const RenderOptions& options) {
  if (options.blockers == Blockers::scene && options.blocking != Blocking::areas) {
    throw Error(ExitCode::usage,
                "blocking: found '{}'{} with blockers 'scene', allowed: areas (or blockers 'seen')",
                name_of(options.blocking), preset_note(options, "blocking"));
  }
  if (!sweeps(options) && options.bounces != Bounces::one) {
    throw Error(ExitCode::usage, "bounces: found '{}' with transport '{}', allowed: 1 (or transport 'sweep')",
                name_of(options.bounces), name_of(options.transport));
  }
  if (!sweeps(options) && options.near == Near::traced) {
    throw Error(ExitCode::usage,
                "near: found '{}'{} with transport '{}', allowed: off (or transport 'sweep')",
                name_of(options.near), preset_note(options, "near"), name_of(options.transport));
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
  return options.blockers == Blockers::seen;
}

int injected_volumes(const RenderOptions& options) {
  return blocked_by_view(options) ? options.cascades : 1;
}

int geometry_volumes(const RenderOptions& options) {
  if (!options.blocked()) return 0;
  return options.blockers == Blockers::scene ? options.cascades : 1;
}

const RenderOptions& checked(const Session& session, const RenderOptions& options, const Basis& basis) {
  require_compatible(options);
  require_supported(session.device(), options.format(), light_shape(options, basis));
  return options;
}

}  // namespace clpv
