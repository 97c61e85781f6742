// SPDX-License-Identifier: MIT
// A frame's options, bases and transport, and the shapes and number of its volumes.
#pragma once

#include <memory>

#include "basis/basis.hpp"
#include "basis/transport.hpp"
#include "options/render_options.hpp"
#include "scene/scene.hpp"
#include "volume/volume_format.hpp"

namespace clpv {

/// Inputs from which frames of a scene are built, checked once. Copies share the bases.
struct FrameSetup {
  /// Throws Error(usage) for contradictory options (validate), and as make_basis and
  /// make_transport.
  FrameSetup(const RenderOptions& resolved, const SceneData& scene);
  /// The same for options of a user (resolve_options).
  FrameSetup(const OptionValues& given, const SceneData& scene);

  RenderOptions options;
  std::shared_ptr<const Basis> basis;     ///< basis of injected light
  std::shared_ptr<const Basis> gathered;  ///< swept_basis() after a sweep, else `basis`
  Transport transport;

  bool sweeps() const { return options.transport == TransportKind::sweep; }
  /// Shapes of volumes of injected and gathered light, and of blockers.
  VolumeShape injected_shape() const { return {options.grid, basis->size(), 3}; }
  /// A sweep adds a channel: its white furnace (Sweeper::set_surfaces).
  VolumeShape gathered_shape() const { return {options.grid, gathered->size(), sweeps() ? 4 : 3}; }
  VolumeShape geometry_shape() const {
    return {options.grid + 1, blocking_size(options.blocking, *basis), 1};
  }
  /// Returns true if surfaces in the camera's G-buffer block light. A new view then recomputes the
  /// RSMs and injected light of every cascade.
  bool blocked_by_view() const { return options.blockers == Blockers::seen; }
  /// Throws Error(usage) if blocked_by_view(): light() and update() have no camera's G-buffer.
  void require_own_blockers() const;
  /// Returns true if the same launches inject the light of all cascades: with a sweep, where their
  /// RSMs and volumes need little memory.
  bool injects_at_once() const;
  /// Number of RSMs in the same memory.
  std::size_t rsms_together() const;
  /// Number of stored volumes of injected light, and of stored RSMs that follow cascades. It is one
  /// per cascade if any frame may need all of them, else one that is recomputed for the current
  /// cascade.
  int injected_volumes() const {
    return blocked_by_view() || injects_at_once() ? options.cascades : 1;
  }
  /// Returns true if links of the sweep transmit what sample points see. Triangles of masked
  /// materials, which hide no points, then block by a geometry volume.
  bool links_by_points() const {
    return sweeps() && options.blockers == Blockers::scene && options.gather == Gathering::visible;
  }
  /// Number of stored geometry volumes: one per cascade for scene blockers, else one; 0 if nothing
  /// needs them. `masked`: the scene has masked materials.
  int geometry_volumes(bool masked) const;
};

}  // namespace clpv
