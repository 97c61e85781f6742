// SPDX-License-Identifier: MIT
#include "pipeline/raster/rasterize.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

#include "kernels/shared/raster.h"
#include "kernels/shared/region.h"
#include "kernels/shared/view_light.h"
#include "pipeline/raster/surface.hpp"
#include "pipeline/raster/view.hpp"

namespace clpv {
namespace {

constexpr std::size_t kRasterGroup = 64;
// Work-items that share the triangles to be clipped, usually none.
constexpr std::size_t kClippers = 1024;
constexpr std::size_t kWideGroupsPerUnit = 4;             // work-groups that enter wide triangles
constexpr std::size_t kMostAhead = std::size_t{1} << 22;  // triangles (256 MiB); longer lists wait
constexpr std::size_t kMostViews = 64;                    // that the same launches draw
constexpr std::size_t kClippedParts = CLPV_CLIP_CORNERS - 2;  // triangles that one can become
constexpr std::size_t kSpare = 4;      // lists grow by an extra 1/4, since cameras move
constexpr unsigned kNearestShare = 6;  // 1/6 of the clusters hide others
constexpr std::size_t kEntryBytes = CLPV_ENTRY_WORDS * sizeof(cl_uint);
const ProgramSource kSetUp{"raster/rasterize.cl"}, kBin{"raster/bin_tiles.cl"},
    kDraw{"raster/draw_tiles.cl"};

/// Returns the largest possible flux of a texel of `view` [W]: albedo 1, at the centre, where
/// texels subtend most.
float largest_flux(const ClpvLight& light, const ClpvView& view) {
  const double texel =
      4.0 * view.half_width * view.half_height / (static_cast<double>(view.width) * view.height);
  const double flux = texel * *std::max_element(light.intensity, light.intensity + 3);
  return flux > 0 ? static_cast<float>(flux) : 1.0f;
}

/// Stably moves the nearest clusters to the front. Returns how many they are.
unsigned move_nearest_first(std::vector<ClpvViewCluster>& clusters) {
  std::vector<float> depths;
  for (const ClpvViewCluster& cluster : clusters) depths.push_back(cluster.nearest);
  const auto last = depths.begin() + static_cast<std::ptrdiff_t>(depths.size() / kNearestShare);
  std::nth_element(depths.begin(), last, depths.end());
  return std::stable_partition(clusters.begin(), clusters.end(),
                               [&](const auto& cluster) { return cluster.nearest <= *last; }) -
         clusters.begin();
}

}  // namespace

unsigned Rasterizer::Drawing::tiles() const {
  return views.size() * tiles_along(views[0].width) * tiles_along(views[0].height);
}

Rasterizer::Rasterizer(Session& session, const SceneBuffers& scene, std::size_t max_listed,
                       std::optional<unsigned> least_hidden)
    : session_(session),
      scene_(scene),
      max_listed_(std::min<std::size_t>(
          max_listed, session.device().max_alloc_bytes / kEntryBytes * kSpare / (kSpare + 1))),
      least_hidden_(least_hidden.value_or(
          session.device().lanes == 1 ? std::numeric_limits<unsigned>::max() : kLeastHidden)),
      set_up_(session, kSetUp, "set_up"),
      set_up_clipped_(session, kSetUp, "set_up_clipped"),
      enter_wide_(session, kSetUp, "enter_wide"),
      prefix_sum_(session),
      bin_entries_(session, kBin, "bin_entries"),
      draw_tiles_(session, kDraw, "draw_tiles"),
      hide_clusters_(session, kDraw, "hide_clusters"),
      resolve_depth_(session, kDraw, "resolve_depth") {
  session_.reserve(counts_, CLPV_RASTER_COUNTERS * sizeof(cl_uint), "counters of the rasteriser");
  session_.reserve(in_slices_, sizeof(cl_uint), "entries in slices");
  reserve_list(scene.triangle_count / 2 + kRasterGroup);
  reserve_entries(scene.triangle_count + kRasterGroup);
}

void Rasterizer::reserve_list(std::size_t count) {
  if (count <= list_room()) return;
  session_.reserve(listed_, (count + count / kSpare) * sizeof(ClpvRasterTriangle),
                   "triangles to draw");
}

cl_uint Rasterizer::list_room() const {
  return listed_.bytes() / sizeof(ClpvRasterTriangle);
}

cl_uint Rasterizer::entry_room() const {
  return entries_.bytes() / kEntryBytes;
}

void Rasterizer::reserve_entries(std::size_t count) {
  if (count <= entry_room()) return;
  count += count / kSpare;
  entries_ = {};  // until memory suffices for all
  session_.reserve(binned_, count * sizeof(cl_uint2), "triangles by tile");
  session_.reserve(wide_, (count / CLPV_FEW_TILES + 1) * sizeof(ClpvWideTriangle),
                   "wide triangles");
  session_.reserve(entries_, count * kEntryBytes, "triangles by tile, unsorted");
}

Kernel& Rasterizer::resolve(const Resolving& wanted) {
  if (const auto found = resolve_.find(wanted); found != resolve_.end()) return found->second;
  const ProgramSource source{"raster/resolve.cl",
                             Literals()
                                 .flag("CLPV_ORTHOGRAPHIC", wanted.orthographic)
                                 .flag("CLPV_SURFACE_PAPER", wanted.paper)
                                 .flag("CLPV_FROM_LIGHT", wanted.from_light)
                                 .flag("CLPV_TEXTURED", scene_.textured)
                                 .flag("CLPV_COLOURED", scene_.coloured)
                                 .flag("CLPV_EMISSIVE", wanted.emissive)
                                 .flag("CLPV_MEDIUM", wanted.from_light && scene_.medium)};
  const char* name = wanted.from_light ? "resolve_rsm" : "resolve_camera";
  return resolve_.try_emplace(wanted, session_, source, name).first->second;
}

void Rasterizer::find_visible(const Drawing& drawing) {
  const std::size_t tiles = drawing.tiles(), pixels = tiles * CLPV_TILE * CLPV_TILE;
  session_.reserve(keys_, pixels * sizeof(cl_float), "keys of the depth test");
  session_.reserve(seen_, pixels * sizeof(cl_uint), "triangles seen");
  session_.reserve(farthest_, tiles * sizeof(cl_float), "farthest keys of tiles");
  const std::uint64_t before = slice_counts_.number();
  session_.reserve(slice_counts_, (std::size_t{drawing.slices()} + 1) * sizeof(cl_uint),
                   "slices of tiles");
  cleared_ = cleared_ && slice_counts_.number() == before;
  session_.reserve(views_, drawing.views.size() * sizeof(ClpvView), "views to draw");
  session_.write(views_, drawing.views);
  const std::vector<Range> ranges = list_clusters(drawing.views);
  draw_range(drawing, ranges[0], true);
  if (ranges.size() > 1) {
    hide_clusters(drawing, ranges[1]);
    draw_range(drawing, ranges[1], false);
  }
  drawn_.insert(drawing.kind);
}

/// Lists the triangle clusters that may be visible: all of them, or the nearest of each view and
/// the others.
std::vector<Rasterizer::Range> Rasterizer::list_clusters(const std::vector<ClpvView>& views) {
  const HostPart part(session_.timeline().host().culling_ms);
  const Boxes& boxes = scene_.clusters->boxes();
  std::array<std::vector<ClpvViewCluster>, 2> listed;
  std::vector<Range> ranges(2);
  for (unsigned v = 0; v < views.size(); ++v) {
    const std::vector<BoxPlace> places = places_of(views[v], boxes);
    std::vector<ClpvViewCluster> visible;
    visible.reserve(places.size());
    for (unsigned i = 0; i < places.size(); ++i) {
      if (places[i] != BoxPlace::outside) visible.push_back({i, v, 0, 0, 0});
    }
    const bool hides = views[v].orthographic != 0 && visible.size() >= least_hidden_;
    // Only hide_clusters reads places.
    for (ClpvViewCluster& cluster : std::span(visible).first(hides ? visible.size() : 0)) {
      cluster = place_cluster(views[v], boxes, cluster.number);
      cluster.view = v;
    }
    const unsigned nearest = hides ? move_nearest_first(visible) : visible.size();
    for (unsigned i = 0; i < visible.size(); ++i) {
      const std::size_t to = i < nearest ? 0 : 1;
      listed[to].push_back(visible[i]);
      ranges[to].clipped += places[visible[i].number] == BoxPlace::clipped ? 1 : 0;
    }
  }
  ranges[0].count = ranges[1].first = listed[0].size();
  ranges[1].count = listed[1].size();
  listed[0].insert(listed[0].end(), listed[1].begin(), listed[1].end());
  if (ranges[1].count == 0) ranges.pop_back();
  session_.reserve(clusters_, (listed[0].size() + 1) * sizeof(ClpvViewCluster),
                   "clusters of triangles in sight");
  session_.reserve(to_clip_, (listed[0].size() + 1) * CLPV_CLUSTER * sizeof(cl_uint),
                   "triangles to clip");
  session_.write(clusters_, listed[0]);
  return ranges;
}

void Rasterizer::draw_range(const Drawing& drawing, const Range& range, bool fresh) {
  if (counted_ != nullptr) count_set_up(range);
  if (list_ahead(drawing, range)) return draw_tiles(drawing, fresh);
  draw(drawing, range.first, range.count, fresh);
}

void Rasterizer::count_set_up(const Range& range) {
  const auto clusters = session_.read<ClpvViewCluster>(clusters_, range.first + range.count);
  for (const ClpvViewCluster& cluster : std::span(clusters).subspan(range.first))
    counted_->set_up += cluster.number == CLPV_HIDDEN ? 0 : CLPV_CLUSTER;
}

/// Leaves out the clusters of a range that lie behind all that has been drawn.
void Rasterizer::hide_clusters(const Drawing& drawing, const Range& range) {
  hide_clusters_.set(views_, range.first, range.count, farthest_, clusters_);
  add_counters(hide_clusters_, drawing).launch(range.count, kRasterGroup);
}

/// Lists the triangles of a range of clusters that may cover a pixel, and adds them to the lists of
/// their tiles.
void Rasterizer::set_up(const Drawing& drawing, unsigned first, unsigned count) {
  const cl_uint cull = drawing.culls_back_faces() ? 1 : 0;
  if (!cleared_) {
    session_.fill_zero(counts_, CLPV_RASTER_COUNTERS * sizeof(cl_uint));
    session_.fill_zero(slice_counts_, slice_counts_.bytes());
  }
  cleared_ = false;
  if (count == 0) return;
  set_up_
      .set(views_, clusters_, first, count, scene_.triangle_count, cull, scene_.vertices,
           scene_.triangles, scene_.materials, counts_, list_room(), listed_, entry_room(),
           entries_, slice_counts_, wide_, to_clip_)
      .launch(count * (std::size_t{CLPV_CLUSTER} / session_.device().lanes), kRasterGroup);
  set_up_clipped_
      .set(views_, clusters_, cull, scene_.vertices, scene_.triangles, scene_.materials, counts_,
           list_room(), listed_, entry_room(), entries_, slice_counts_, wide_, to_clip_)
      .launch(kClippers, kRasterGroup);
  if (session_.device().lanes != 1) return;
  enter_wide_
      .set(views_, counts_, list_room(), entry_room(), listed_, wide_, entries_, slice_counts_)
      .launch(session_.device().compute_units * kWideGroupsPerUnit * kRasterGroup, kRasterGroup);
}

/// Adds the counters to a kernel that zeroes them for the next set_up().
Kernel& Rasterizer::add_counters(Kernel& kernel, const Drawing& drawing) {
  cleared_ = true;
  return kernel.add(drawing.slices(), counts_, slice_counts_);
}

/// Sorts the entries of set_up() by tile.
void Rasterizer::bin(const Drawing& drawing) {
  prefix_sum_.run(slice_counts_, drawing.slices(), in_slices_);
  const std::size_t groups = (entry_room() + CLPV_ENTRY_GROUP - 1) / CLPV_ENTRY_GROUP;
  bin_entries_.set(counts_, list_room(), entry_room(), entries_, slice_counts_, binned_)
      .launch(groups * kRasterGroup, kRasterGroup);
}

/// Lists the triangles of a range of clusters by tile, and grows lists that are too short. Returns
/// false if a list would exceed its limit.
bool Rasterizer::list(const Drawing& drawing, unsigned first, unsigned count) {
  for (;;) {
    set_up(drawing, first, count);
    bin(drawing);
    const std::vector<cl_uint> counts = session_.read<cl_uint>(counts_, CLPV_RASTER_COUNTERS);
    const std::size_t listed = counts[CLPV_LISTED], entered = counts[CLPV_ENTERED];
    entered_ = std::max(entered_, entered);
    if (count > 1 && (counts[CLPV_ENTERED_TOO_MANY] > 0 || entered > max_listed_)) return false;
    if (listed <= list_room() && entered <= entry_room()) return true;
    reserve_list(listed);
    reserve_entries(entered);
  }
}

/// Lists the triangles of the visible clusters without waiting. The list has room for all of them,
/// but tiles' entries may not fit. Returns false if the host has to wait.
bool Rasterizer::list_ahead(const Drawing& drawing, const Range& range) {
  take_counts();
  const std::size_t most = CLPV_CLUSTER * (range.count + (kClippedParts - 1) * range.clipped);
  if (!ahead_ || !drawn_.contains(drawing.kind) || most > kMostAhead || entered_ > max_listed_)
    return false;
  reserve_list(most);
  reserve_entries(entered_);
  set_up(drawing, range.first, range.count);
  bin(drawing);
  counting_.push_back(session_.read_later(counts_, CLPV_RASTER_COUNTERS));
  return true;
}

/// Takes the counters that have arrived.
void Rasterizer::take_counts() {
  for (; !counting_.empty() && counting_.front()->arrived(); counting_.pop_front()) {
    const std::vector<cl_uint>& counts = counting_.front()->values;
    const bool overflow = counts[CLPV_ENTERED_TOO_MANY] > 0;
    entered_ = std::max<std::size_t>(entered_, overflow ? max_listed_ + 1 : counts[CLPV_ENTERED]);
  }
}

/// Draws a range of clusters. `fresh`: starts from an empty surface, else adds to it. Halves the
/// range if the tile lists would exceed their limit.
void Rasterizer::draw(const Drawing& drawing, unsigned first, unsigned count, bool fresh) {
  if (list(drawing, first, count)) return draw_tiles(drawing, fresh);
  draw(drawing, first, count / 2, fresh);
  draw(drawing, first + count / 2, count - count / 2, false);
}

/// Entries of the fullest tile, if the timeline counts chains.
Chain Rasterizer::longest_list(const Drawing& drawing) {
  if (!session_.timeline().counts_chains()) return {};
  const auto starts = session_.read<cl_uint>(slice_counts_, drawing.slices() + 1);
  std::size_t longest = 0;
  for (std::size_t i = 0; i + CLPV_SLICES < starts.size(); i += CLPV_SLICES)
    longest = std::max<std::size_t>(longest, starts[i + CLPV_SLICES] - starts[i]);
  return Chain{longest};
}

void Rasterizer::draw_tiles(const Drawing& drawing, bool fresh) {
  const unsigned across = tiles_along(drawing.views[0].width),
                 down = tiles_along(drawing.views[0].height);
  const bool only_depth = drawing.kind == Kind::shadow;
  draw_tiles_
      .set(views_, cl_uint{fresh}, cl_uint{only_depth}, listed_, slice_counts_, binned_, counts_,
           entry_room(), scene_.vertices, scene_.triangles, scene_.materials, scene_.textures,
           scene_.texels, keys_, seen_, farthest_)
      .launch(session_.device().lanes == 1 ? drawing.items(across * CLPV_TILE, down * CLPV_TILE)
                                           : drawing.items(across, down),
              drawing.group(session_), longest_list(drawing));
  if (counted_ == nullptr) return;
  const std::vector<cl_uint> counts = session_.read<cl_uint>(counts_, CLPV_RASTER_COUNTERS);
  counted_->listed += counts[CLPV_LISTED];
  counted_->entries += counts[CLPV_ENTERED];
}

void Rasterizer::clear(Surface& surface) {
  const std::size_t texel =
      surface.format == RsmFormat::paper ? sizeof(cl_uchar4) : sizeof(cl_float4);
  const std::size_t count = std::size_t{surface.view.width} * surface.view.height;
  session_.fill_zero(surface.depth, count * sizeof(cl_float), surface.first * sizeof(cl_float));
  for (const Buffer& texels : {surface.normal, surface.colour})
    session_.fill_zero(texels, count * texel, surface.first * texel);
}

void Rasterizer::rasterize_camera(Surface& surface) {
  const ClpvView& view = surface.view;
  const bool has_emissive = surface.emissive.exists();
  if (has_emissive && !scene_.emissive) {
    session_.fill_zero(surface.emissive, std::size_t{view.width} * view.height * sizeof(cl_float4));
  }
  if (scene_.triangle_count == 0) return clear(surface);
  const Drawing drawing{{view}, Kind::camera};
  find_visible(drawing);
  const bool emissive = has_emissive && scene_.emissive;
  Kernel& kernel = resolve({.orthographic = view.orthographic != 0,
                            .from_light = false,
                            .paper = surface.format == RsmFormat::paper,
                            .emissive = emissive});
  kernel.set(view, keys_, seen_, scene_.vertices, scene_.triangles, scene_.materials,
             scene_.textures, scene_.texels, surface.depth, surface.normal, surface.colour,
             emissive ? surface.emissive : surface.colour);
  launch_resolve(kernel, drawing);
}

void Rasterizer::rasterize_rsms(std::span<const Rsm> rsms) {
  const std::size_t most = std::clamp(kMostAhead / std::max<std::size_t>(scene_.triangle_count, 1),
                                      std::size_t{1}, kMostViews);
  while (!rsms.empty()) {
    const Surface& first = *rsms[0].surface;
    const auto end = std::ranges::find_if(rsms, [&](const Rsm& rsm) {
      const Surface& s = *rsm.surface;
      return s.depth.number() != first.depth.number() || s.view.width != first.view.width ||
             s.view.height != first.view.height || s.view.orthographic != first.view.orthographic;
    });
    const std::size_t count = std::min<std::size_t>(end - rsms.begin(), most);
    draw_rsms(rsms.first(count));
    rsms = rsms.subspan(count);
  }
}

/// Draws maps by the same launches.
void Rasterizer::draw_rsms(std::span<const Rsm> rsms) {
  Drawing drawing{{}, Kind::rsm};
  std::vector<ClpvLitView> lit;
  for (const auto& [light, surface] : rsms) {
    if (surface->format == RsmFormat::paper)
      surface->colour_scale = largest_flux(light, surface->view);
    if (scene_.triangle_count == 0) clear(*surface);
    drawing.views.push_back(surface->view);
    lit.push_back({surface->view, light, surface->colour_scale, surface->first});
  }
  if (scene_.triangle_count == 0) return;
  find_visible(drawing);
  session_.reserve(lit_views_, lit.size() * sizeof(ClpvLitView), "views of lights");
  session_.write(lit_views_, lit);
  const Surface& surface = *rsms[0].surface;
  Kernel& kernel = resolve({.orthographic = surface.view.orthographic != 0,
                            .from_light = true,
                            .paper = surface.format == RsmFormat::paper,
                            .emissive = false});
  kernel.set(lit_views_, keys_, seen_, scene_.vertices, scene_.triangles, scene_.materials,
             scene_.textures, scene_.texels, surface.depth, surface.normal, surface.colour);
  launch_resolve(kernel, drawing);
}

void Rasterizer::rasterize_shadow(const ClpvView& view, Buffer& depth) {
  const Drawing drawing{{view}, Kind::shadow};
  find_visible(drawing);
  resolve_depth_.set(view, keys_, depth);
  launch_resolve(resolve_depth_, drawing);
}

/// Launches a kernel over the pixels of all views.
void Rasterizer::launch_resolve(Kernel& kernel, const Drawing& drawing) {
  const ClpvView& view = drawing.views[0];
  add_counters(kernel, drawing)
      .launch(drawing.items(items_along(session_, view.width), view.height),
              drawing.group(session_));
}

}  // namespace clpv
