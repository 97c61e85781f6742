// SPDX-License-Identifier: MIT
// Rasterises a scene into what a view sees: reflective shadow maps, the camera's G-buffer, shadow maps.
//
// Vertices snap to 1/256 pixel; edges are then exact in integers and follow the top-left rule, so that
// triangles which share an edge leave no pixel out and draw none twice. Of two surfaces at the same depth the
// triangle that comes first in the scene is seen: two clusters give the same bytes.
#pragma once

#include <compare>
#include <map>

#include "device/kernel.hpp"
#include "device/session.hpp"
#include "pipeline/scene_buffers.hpp"
#include "pipeline/surface.hpp"

namespace clpv {

class Rasterizer {
 public:
  /// Entries of all tiles' lists of triangles held at a time, 4 bytes each. A scene that needs more (hundreds of
  /// screen-filling layers) is drawn in several goes, of a run of triangles at least; the result is the same.
  static constexpr std::size_t kMostListed = std::size_t{1} << 25;

  /// `scene` must stay as it is while the rasteriser lives (its handles are copied, not its contents).
  Rasterizer(Session& session, const SceneBuffers& scene, std::size_t most_listed = kMostListed);

  /// The camera's G-buffer, as `surface.view` sees the scene: depth, normal, albedo and, where the surface
  /// has it, emission. Back faces are culled unless their material is double-sided. Textures are filtered
  /// trilinearly.
  void rasterize_camera(Surface& surface);

  /// A reflective shadow map of `light`, as `surface.view` sees the scene: depth, normal, and as colour the
  /// flux [W] of each texel's virtual point light, albedo x irradiance x footprint (kernels/lighting.h). Both
  /// sides of every triangle are lit. In format paper it sets Surface::colour_scale to the largest flux a
  /// texel can have.
  void rasterize_rsm(const ClpvLight& light, Surface& surface);

  /// Depth alone [m], 0 where there is no surface, into view.width x view.height floats. Both sides cast
  /// shadows.
  void rasterize_shadow(const ClpvView& view, Buffer& depth);

 private:
  struct Pass {
    ClpvView view;
    bool cull_back_faces;
  };

  /// Of one projection, which is in the code: chosen as it clusters, it would take RSMs a twelfth longer.
  struct SetUp {
    Kernel triangles, clipped;
  };
  SetUp& set_up_kernels(const ClpvView& view);
  /// What the code that resolves a surface is made for.
  struct Resolving {
    bool orthographic, from_light, paper, emissive;
    auto operator<=>(const Resolving&) const = default;
  };
  Kernel& resolve(const Resolving& wanted);

  void reserve_list(std::size_t count);
  void reserve_entries(std::size_t count);
  cl_uint list_room() const;   ///< triangles there is room for
  cl_uint entry_room() const;  ///< and entries
  void clear(Surface& surface);
  void find_visible(const Pass& pass);
  unsigned list_runs(const ClpvView& view);
  void draw(const Pass& pass, unsigned first, unsigned count, bool fresh);
  bool list(const Pass& pass, unsigned first, unsigned count);
  void set_up(const Pass& pass, unsigned first, unsigned count);
  void bin(const ClpvView& view);
  void draw_tiles(const ClpvView& view, bool fresh);

  Session& session_;
  SceneBuffers scene_;
  std::size_t most_listed_;
  std::map<bool, SetUp> set_up_;  ///< by whether the projection is orthographic
  std::map<Resolving, Kernel> resolve_;
  Kernel sum_slices_, scan_slices_, bin_entries_, draw_tiles_, resolve_depth_;
  Buffer clusters_, listed_, to_clip_, counts_, entries_, slice_counts_, totals_, binned_, keys_, seen_;
};

}  // namespace clpv
