// SPDX-License-Identifier: MIT
// Rasterises a scene into reflective shadow maps, the camera's G-buffer and shadow maps.
//
// Vertices snap to 1/256 pixel, so edges are exact in integers and follow the top-left rule.
// Triangles that share an edge therefore neither skip a pixel nor draw one twice. At equal depth
// the triangle that comes first in the scene wins. Results are deterministic to the byte.
#pragma once

#include <array>
#include <compare>
#include <deque>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <span>
#include <vector>

#include "device/kernel.hpp"
#include "device/session.hpp"
#include "pipeline/raster/scene_buffers.hpp"
#include "pipeline/raster/surface.hpp"

namespace clpv {

/// Triangles whose corners are projected, triangles listed to draw, and their entries: one for each
/// tile of a triangle's box.
struct RasterCounts {
  double set_up = 0, listed = 0, entries = 0;
};

class Rasterizer {
 public:
  /// Capacity of the triangle lists of all tiles, in entries, if a buffer may have as many. Larger
  /// scenes (hundreds of screen-filling layers) are drawn in several passes of at least one
  /// triangle cluster each; the result is the same.
  static constexpr std::size_t kMaxListed = std::size_t{1} << 25;

  /// Clusters in an orthographic view from which on it is drawn in two parts: the nearest, then
  /// those that they do not hide. Below, and with one lane, whose tiles leave out 64 hidden
  /// triangles at once, further launches take more time than they save.
  static constexpr unsigned kLeastHidden = 512;

  /// `scene` must not change while the rasteriser exists. Its handles are copied, not its contents.
  Rasterizer(Session& session, const SceneBuffers& scene, std::size_t max_listed = kMaxListed,
             std::optional<unsigned> least_hidden = {});

  /// Renders the camera's G-buffer from `surface.view`: depth, normal, albedo and, if the surface
  /// has it, emission. Culls back faces unless their material is double-sided. Filters textures
  /// trilinearly.
  void rasterize_camera(Surface& surface);

  struct Rsm {
    ClpvLight light;
    Surface* surface;
  };
  /// Renders reflective shadow maps from the views of their surfaces: depth, normal, colour. Colour
  /// is the flux [W] of the virtual point light of each texel: albedo x irradiance x footprint
  /// (kernels/raster/lighting.h). Both sides of every triangle are lit. In format paper it sets
  /// Surface::colour_scale to the largest possible flux of a texel. The same launches draw
  /// successive maps of one size in the same buffers.
  void rasterize_rsms(std::span<const Rsm> rsms);
  void rasterize_rsm(const ClpvLight& light, Surface& surface) {
    rasterize_rsms(std::array{Rsm{light, &surface}});
  }

  /// Renders only depth [m], 0 without a surface, into view.width x view.height floats. Both sides
  /// cast shadows.
  void rasterize_shadow(const ClpvView& view, Buffer& depth);

  /// Sets whether views are drawn without waiting for the device. Waiting, the host reads how many
  /// entries the triangle lists need, and grows them first. Otherwise lists have the size that
  /// earlier views needed. A view that needs more is drawn without lists of tiles: with the same
  /// result, but slowly. The first view of each kind, and scenes with lists beyond the limit,
  /// always wait.
  void draw_ahead(bool ahead) { ahead_ = ahead; }

  /// Adds the counts of all later views to `counts`, and waits for the device each time; null:
  /// stops.
  void count(RasterCounts* counts) { counted_ = counts; }

 private:
  enum class Kind { camera, rsm, shadow };
  struct Drawing {  ///< views of one size that the same launches draw
    std::vector<ClpvView> views;
    Kind kind;
    bool culls_back_faces() const { return kind == Kind::camera; }
    unsigned tiles() const;
    unsigned slices() const { return tiles() * CLPV_SLICES; }
    cl::NDRange items(unsigned along_x, unsigned along_y) const {
      return {along_x, along_y, views.size()};
    }
    cl::NDRange group(const Session& session) const {
      const cl::NDRange flat = pixel_group(session);
      return {flat.get()[0], flat.get()[1], 1};
    }
  };

  /// Variant of the resolve kernel.
  struct Resolving {
    bool orthographic, from_light, paper, emissive;
    auto operator<=>(const Resolving&) const = default;
  };
  Kernel& resolve(const Resolving& wanted);

  void reserve_list(std::size_t count);
  void reserve_entries(std::size_t count);
  cl_uint list_room() const;   ///< capacity in triangles
  cl_uint entry_room() const;  ///< capacity in entries
  void clear(Surface& surface);
  void find_visible(const Drawing& drawing);
  /// A range of the clusters in view.
  struct Range {
    unsigned first = 0, count = 0;
    unsigned clipped = 0;  ///< those whose triangles may need clipping
  };
  std::vector<Range> list_clusters(const std::vector<ClpvView>& views);
  void draw_rsms(std::span<const Rsm> rsms);
  void launch_resolve(Kernel& kernel, const Drawing& drawing);
  void draw_range(const Drawing& drawing, const Range& range, bool fresh);
  void hide_clusters(const Drawing& drawing, const Range& range);
  void count_set_up(const Range& range);
  void draw(const Drawing& drawing, unsigned first, unsigned count, bool fresh);
  bool list(const Drawing& drawing, unsigned first, unsigned count);
  bool list_ahead(const Drawing& drawing, const Range& range);
  void take_counts();
  void set_up(const Drawing& drawing, unsigned first, unsigned count);
  Kernel& add_counters(Kernel& kernel, const Drawing& drawing);
  void bin(const Drawing& drawing);
  Chain longest_list(const Drawing& drawing);
  void draw_tiles(const Drawing& drawing, bool fresh);

  Session& session_;
  SceneBuffers scene_;
  std::size_t max_listed_;
  unsigned least_hidden_;
  Kernel set_up_, set_up_clipped_, enter_wide_;
  std::map<Resolving, Kernel> resolve_;
  PrefixSum prefix_sum_;
  Kernel bin_entries_, draw_tiles_, hide_clusters_, resolve_depth_;
  bool ahead_ = false, cleared_ = false;  ///< counts_, slice_counts_ are zero
  RasterCounts* counted_ = nullptr;
  std::set<Kind> drawn_;     ///< kinds of views drawn so far
  std::size_t entered_ = 0;  ///< largest number of entries so far
  /// Counters of views drawn ahead.
  std::deque<std::shared_ptr<const Session::Arriving>> counting_;
  Buffer views_, lit_views_;  ///< of the drawing
  Buffer clusters_, listed_, to_clip_, wide_, counts_, entries_, slice_counts_, in_slices_, binned_,
      keys_, seen_, farthest_;
};

}  // namespace clpv
