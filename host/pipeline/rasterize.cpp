// SPDX-License-Identifier: MIT
#include "pipeline/rasterize.hpp"

#include <algorithm>
#include <numeric>

#include "kernels/shared/raster.h"

namespace clpv {
namespace {

static_assert(sizeof(ClpvProjected) == CLPV_SIZEOF_PROJECTED &&
              sizeof(ClpvRasterTriangle) == CLPV_SIZEOF_RASTER_TRIANGLE);

constexpr std::size_t kGroup = 64;
const cl::NDRange kTileRow(8, 1);  // tiles differ in work: small groups even it out between cores

unsigned tiles_along(unsigned pixels) {
  return (pixels + CLPV_TILE - 1) / CLPV_TILE;
}
unsigned tile_count(const ClpvView& view) {
  return tiles_along(view.width) * tiles_along(view.height);
}
/// A work-item a row of pixels of a tile.
cl::NDRange rows_of_tiles(const ClpvView& view) {
  return {tiles_along(view.width), view.height};
}
unsigned padded_pixels(const ClpvView& view) {
  return tile_count(view) * CLPV_TILE * CLPV_TILE;
}

/// The largest flux a texel of `view` can have [W]: albedo 1, at the middle of the view, where texels see
/// most.
float largest_flux(const ClpvLight& light, const ClpvView& view) {
  const double texel =
      4.0 * view.half_width * view.half_height / (static_cast<double>(view.width) * view.height);
  const double flux = texel * *std::max_element(light.intensity, light.intensity + 3);
  return flux > 0 ? static_cast<float>(flux) : 1.0f;
}

}  // namespace

Rasterizer::Rasterizer(Session& session, const SceneBuffers& scene, std::size_t most_listed)
    : session_(session), scene_(scene), most_listed_(most_listed) {
  session_.reserve(counts_, 2 * sizeof(cl_uint), "counters of the rasteriser");
  session_.reserve(to_clip_, scene.triangle_count * sizeof(cl_uint), "triangles to clip");
  session_.reserve(projected_, scene.vertex_count * sizeof(ClpvProjected), "projected vertices");
  session_.reserve(listed_, (scene.triangle_count / 2 + kGroup) * sizeof(ClpvRasterTriangle),
                   "triangles to draw");
}

Rasterizer::Drawing Rasterizer::make_drawing(bool orthographic) const {
  const Literals literals = Literals().flag("CLPV_ORTHOGRAPHIC", orthographic);
  const ProgramSource list{"rasterize.cl", literals, {}}, draw{"draw_tiles.cl", literals, {}};
  return {Kernel(session_, list, "project_vertices"), Kernel(session_, list, "set_up"),
          Kernel(session_, list, "set_up_clipped"),   Kernel(session_, list, "bin_triangles"),
          Kernel(session_, draw, "draw_tiles"),       Kernel(session_, draw, "resolve_depth")};
}

Rasterizer::Drawing& Rasterizer::drawing(const ClpvView& view) {
  const bool orthographic = view.orthographic != 0;
  auto found = drawing_.find(orthographic);
  if (found == drawing_.end()) found = drawing_.emplace(orthographic, make_drawing(orthographic)).first;
  return found->second;
}

Kernel& Rasterizer::resolve(const Resolving& wanted) {
  if (const auto found = resolve_.find(wanted); found != resolve_.end()) return found->second;
  const ProgramSource source{"resolve.cl",
                             Literals()
                                 .flag("CLPV_ORTHOGRAPHIC", wanted.orthographic)
                                 .flag("CLPV_SURFACE_PAPER", wanted.paper)
                                 .flag("CLPV_FROM_LIGHT", wanted.from_light)
                                 .flag("CLPV_TEXTURED", scene_.textured)
                                 .flag("CLPV_COLOURED", scene_.coloured)
                                 .flag("CLPV_EMISSIVE", wanted.emissive),
                             {}};
  const char* name = wanted.from_light ? "resolve_rsm" : "resolve_camera";
  return resolve_.try_emplace(wanted, session_, source, name).first->second;
}

void Rasterizer::find_visible(const Pass& pass) {
  const std::size_t pixels = padded_pixels(pass.view);
  session_.reserve(keys_, pixels * sizeof(cl_float), "keys of the depth test");
  session_.reserve(seen_, pixels * sizeof(cl_uint), "triangles seen");
  if (scene_.vertex_count > 0) {
    drawing(pass.view)
        .project.set(pass.view, scene_.vertex_count, scene_.vertices, projected_)
        .launch(scene_.vertex_count, kGroup);
  }
  draw(pass, 0, scene_.triangle_count, true);
}

/// Lists the triangles of a range that may cover a pixel, growing the list where it is too short. Returns how
/// many.
unsigned Rasterizer::set_up(const Pass& pass, unsigned first, unsigned count) {
  if (count == 0) return 0;
  Drawing& kernels = drawing(pass.view);
  const cl_uint cull = pass.cull_back_faces ? 1 : 0;
  for (;;) {
    const auto capacity = static_cast<cl_uint>(listed_.bytes() / sizeof(ClpvRasterTriangle));
    session_.write(counts_, std::vector<cl_uint>(2, 0));
    kernels.set_up
        .set(pass.view, first, count, cull, scene_.vertices, scene_.triangles, scene_.materials, projected_,
             counts_, capacity, listed_, to_clip_)
        .launch(count, kGroup);
    std::vector<cl_uint> counts = session_.read<cl_uint>(counts_, 2);
    if (counts[1] > 0) {
      kernels.set_up_clipped
          .set(pass.view, counts[1], cull, scene_.vertices, scene_.triangles, scene_.materials, counts_,
               capacity, listed_, to_clip_)
          .launch(counts[1], kGroup);
      counts = session_.read<cl_uint>(counts_, 2);
    }
    if (counts[0] <= capacity) return counts[0];
    session_.reserve(listed_, counts[0] * sizeof(ClpvRasterTriangle), "triangles to draw");
  }
}

void Rasterizer::bin(const ClpvView& view, unsigned listed, bool fill) {
  if (listed == 0) return;
  drawing(view)
      .bin.set(listed, tiles_along(view.width), cl_uint{fill}, listed_, places_, binned_)
      .launch(listed, kGroup);
}

/// Draws a range of triangles; `fresh`: onto nothing, else onto what is there. Halves the range where the tiles'
/// lists would grow too long.
void Rasterizer::draw(const Pass& pass, unsigned first, unsigned count, bool fresh) {
  const ClpvView& view = pass.view;
  const unsigned listed = set_up(pass, first, count);
  session_.reserve(places_, tile_count(view) * sizeof(cl_uint), "tiles");
  session_.reserve(binned_, sizeof(cl_uint), "triangles by tile");
  session_.write(places_, std::vector<cl_uint>(tile_count(view), 0));
  bin(view, listed, false);
  std::vector<cl_uint> places = session_.read<cl_uint>(places_, tile_count(view));
  const std::size_t total = std::accumulate(places.begin(), places.end(), std::size_t{0});
  if (total > most_listed_ && count > 1) {
    draw(pass, first, count / 2, fresh);
    draw(pass, first + count / 2, count - count / 2, false);
    return;
  }
  // Where each tile's list starts, one after another.
  std::exclusive_scan(places.begin(), places.end(), places.begin(), cl_uint{0});
  session_.write(places_, places);
  session_.reserve(binned_, total * sizeof(cl_uint), "triangles by tile");
  bin(view, listed, true);
  draw_tiles(view, fresh);
}

void Rasterizer::draw_tiles(const ClpvView& view, bool fresh) {
  drawing(view)
      .draw_tiles
      .set(view, cl_uint{fresh}, listed_, places_, binned_, scene_.vertices, scene_.triangles,
           scene_.materials, scene_.textures, scene_.texels, keys_, seen_)
      .launch(cl::NDRange(tiles_along(view.width), tiles_along(view.height)), kTileRow);
}

void Rasterizer::clear(Surface& surface) {
  const std::size_t texel = surface.format == RsmFormat::paper ? sizeof(cl_uchar4) : sizeof(cl_float4);
  const std::size_t count = std::size_t{surface.view.width} * surface.view.height;
  session_.fill_zero(surface.depth, count * sizeof(cl_float));
  session_.fill_zero(surface.normal, count * texel);
  session_.fill_zero(surface.colour, count * texel);
}

void Rasterizer::rasterize_camera(Surface& surface) {
  const ClpvView& view = surface.view;
  const bool has_emissive = surface.emissive.exists();
  if (has_emissive && !scene_.emissive) {
    session_.fill_zero(surface.emissive, std::size_t{view.width} * view.height * sizeof(cl_float4));
  }
  if (scene_.triangle_count == 0) return clear(surface);
  find_visible({view, true});
  const bool emissive = has_emissive && scene_.emissive;
  Kernel& kernel = resolve({.orthographic = view.orthographic != 0,
                            .from_light = false,
                            .paper = surface.format == RsmFormat::paper,
                            .emissive = emissive});
  kernel.set(view, keys_, seen_, scene_.vertices, scene_.triangles, scene_.materials, scene_.textures,
             scene_.texels, surface.depth, surface.normal, surface.colour);
  if (emissive) kernel.add(surface.emissive);
  kernel.launch(rows_of_tiles(view), kTileRow);
}

void Rasterizer::rasterize_rsm(const ClpvLight& light, Surface& surface) {
  const ClpvView& view = surface.view;
  if (surface.format == RsmFormat::paper) surface.colour_scale = largest_flux(light, view);
  if (scene_.triangle_count == 0) return clear(surface);
  find_visible({view, false});
  resolve({.orthographic = view.orthographic != 0,
           .from_light = true,
           .paper = surface.format == RsmFormat::paper,
           .emissive = false})
      .set(view, light, keys_, seen_, scene_.vertices, scene_.triangles, scene_.materials, scene_.textures,
           scene_.texels, surface.depth, surface.normal, surface.colour, surface.colour_scale)
      .launch(rows_of_tiles(view), kTileRow);
}

void Rasterizer::rasterize_shadow(const ClpvView& view, Buffer& depth) {
  find_visible({view, false});
  drawing(view).resolve_depth.set(view, keys_, depth).launch(rows_of_tiles(view), kTileRow);
}

}  // namespace clpv
