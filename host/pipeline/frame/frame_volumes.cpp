// SPDX-License-Identifier: MIT
#include "pipeline/frame/frame_volumes.hpp"

#include "basis/sweep.hpp"
#include "support/error.hpp"

namespace clpv {
VolumeShape light_shape(const RenderOptions& options, const Basis& basis) {
  return {options.grid, basis.size(), 3};
}

VolumeShape geometry_shape(const RenderOptions& options, const Basis& basis) {
  return {options.grid + 1, blocking_size(options.blocking, basis), 1};
}

std::unique_ptr<Basis> swept_basis(const RenderOptions& options) {
  return options.transport == TransportKind::sweep ? swept_basis() : nullptr;
}

bool blocked_by_view(const RenderOptions& options) {
  return options.blockers == Blockers::seen;
}

void require_own_blockers(const RenderOptions& options) {
  if (!blocked_by_view(options)) return;
  throw Error(ExitCode::usage,
              "light: found blockers '{}', which a frame's G-buffer makes, allowed: scene",
              name_of(options.blockers));
}

int injected_volumes(const RenderOptions& options) {
  return blocked_by_view(options) ? options.cascades : 1;
}

int geometry_volumes(const RenderOptions& options) {
  if (!options.blocked()) return 0;
  return options.blockers == Blockers::scene ? options.cascades : 1;
}

}  // namespace clpv
