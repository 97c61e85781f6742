// SPDX-License-Identifier: MIT
#include "pipeline/gather/near.hpp"

#include "basis/sampling.hpp"
#include "kernels/shared/near.h"
#include "kernels/shared/pixel_planes.h"

namespace clpv {
namespace {

unsigned near_pixels(unsigned pixels, int step) {
  return (pixels + step - 1) / step;
}

/// Number of layers of pixels (pixel_planes.h).
int layers(int step) {
  return step == 1 ? 1 : 2;
}

/// Rows of all layers.
unsigned near_rows(unsigned height, int step) {
  const unsigned rows = near_pixels(height, step);
  return layers(step) == 1 ? rows : second_plane_row(rows) + rows;
}

unsigned tiles_down(unsigned rows) {
  return (rows + CLPV_PLANE_TILE - 1) / CLPV_PLANE_TILE;
}

ProgramSource near_source(const char* file, const SceneBuffers& buffers,
                          const NearOptions& options) {
  ProgramSource source{file};
  source.literals.integer("CLPV_PLANE_STEP", options.step)
      .integer("CLPV_PLANE_LAYERS", layers(options.step))
      .number("CLPV_NEAR_RAYS", options.rays)
      .real("CLPV_NEAR_CONE", near_cone(options.rays))
      .flag("CLPV_TEXTURED", buffers.textured)
      .flag("CLPV_COLOURED", buffers.coloured)
      .flag("CLPV_EMISSIVE", buffers.emissive)
      .flag("CLPV_MEDIUM", buffers.medium);
  return source;
}

ProgramSource reflecting(ProgramSource source) {
  source.literals.flag("CLPV_NEAR_REFLECT", true);
  return source;
}

/// Directions in the order of near_layout.h.
std::vector<cl_float8> direction_rows(int rays) {
  const std::vector<std::vector<glm::vec3>> directions = near_directions(rays);
  std::vector<cl_float8> rows;
  for (int y = 0; y < CLPV_PLANE_TILE; ++y) {
    for (int ray = 0; ray < rays; ++ray) {
      for (int axis = 0; axis < 3; ++axis) {
        cl_float8& row = rows.emplace_back();
        for (int lane = 0; lane < 8; ++lane)
          row.s[lane] = directions[CLPV_PLANE_TILE * y + lane % CLPV_PLANE_TILE][ray][axis];
      }
    }
  }
  return rows;
}

}  // namespace

NearField::NearField(Session& session, const Basis& basis, const SceneData& scene,
                     const SceneBuffers& buffers, const NearOptions& options)
    : session_(session),
      scene_(scene),
      buffers_(buffers),
      options_(options),
      building_(std::async(std::launch::async, [&scene] { return TriangleTree(scene); })),
      trace_(session, near_source("gather/near_trace.cl", buffers, options), "near_trace"),
      light_(session, near_source("gather/near_light.cl", buffers, options), "near_light"),
      emit_(session, near_source("gather/near_light.cl", buffers, options), "near_emit"),
      near_(session,
            with_radiance(near_source("gather/near.cl", buffers, options), basis, options.gather),
            "near"),
      blur_(session, near_source("gather/near_filter.cl", buffers, options), "near_blur"),
      widen_(session, near_source("gather/near_filter.cl", buffers, options), "near_widen"),
      points_source_(with_radiance(near_source("gather/near_points.cl", buffers, options), basis,
                                   options.gather)),
      filter_source_(near_source("gather/near_filter.cl", buffers, options)) {
  pixel_kernels(false);
  if (options.reflects) {
    reflect_.emplace(session,
                     reflecting(with_radiance(near_source("gather/near_light.cl", buffers, options),
                                              basis, options.gather)),
                     "near_reflect");
  }
  directions_ = session.upload(direction_rows(options.rays), "directions of the near field");
}

NearField::PixelKernels& NearField::pixel_kernels(bool points) {
  if (const auto found = pixel_kernels_.find(points); found != pixel_kernels_.end())
    return found->second;
  ProgramSource of_points = points_source_, of_filter = filter_source_;
  if (points) {
    of_points.literals.flag("CLPV_POINTS", true);
    of_filter.literals.flag("CLPV_POINTS", true);
  }
  PixelKernels made{
      {session_, of_points, "near_points"}, std::nullopt, {session_, of_filter, "near_add"}};
  if (layers(options_.step) > 1) made.others.emplace(session_, of_points, "near_others");
  return pixel_kernels_.emplace(points, std::move(made)).first->second;
}

void NearField::move() {
  tree_->move(scene_);
  uploaded_ = false;
  finish();
}

void NearField::finish() {
  if (!tree_) tree_ = building_.get();
  if (uploaded_) return;
  session_.reserve(nodes_, tree_->nodes().size() * sizeof(TreeRow), "tree of triangles");
  session_.reserve(leaves_, tree_->leaves().size() * sizeof(TreeRow),
                   "leaves of the tree of triangles");
  session_.write(nodes_, tree_->nodes());
  session_.write(leaves_, tree_->leaves());
  uploaded_ = true;
}

/// Rays of a tile that has as many pixels along x as a work-item.
std::size_t NearField::rays_of_tile() const {
  return std::size_t{CLPV_PLANE_TILE} * options_.rays;
}

void NearField::reserve(const ClpvView& view) {
  const unsigned width = near_pixels(view.width, options_.step),
                 height = near_rows(view.height, options_.step);
  const std::size_t numbers = std::size_t{pixel_plane_size(width, height)} * sizeof(cl_float);
  if (width == width_ && height == height_) return;
  width_ = height_ = 0;  // until memory suffices
  session_.reserve(points_, CLPV_NEAR_PLANES * numbers, "points of the near field");
  session_.reserve(distances_, options_.rays * numbers, "distances of the near field");
  const std::size_t tiles = items_along(session_, width) * tiles_down(height),
                    lanes = session_.device().lanes;
  session_.reserve(counts_, tiles * (lanes == 1 ? rays_of_tile() : 1) * sizeof(cl_uint),
                   "hits of the near field");
  const std::size_t hits = tiles * lanes * rays_of_tile() * CLPV_HIT_ROWS * sizeof(cl_float);
  session_.reserve(hits_, hits, "hits of the near field");
  session_.reserve(radiances_, 3 * options_.rays * numbers, "radiance of the near field");
  session_.reserve(near_light_, CLPV_NEAR_LIGHT_PLANES * numbers, "near field");
  session_.reserve(blurred_, CLPV_NEAR_LIGHT_PLANES * numbers, "blurred near field");
  // Kernels read, but do not use, entries after a tile's last hit and radiances of rays without a
  // hit.
  session_.fill_zero(hits_, hits);
  session_.fill_zero(radiances_, 3 * options_.rays * numbers);
  session_.fill_zero(near_light_, CLPV_NEAR_LIGHT_PLANES * numbers);  // borders stay 0
  session_.fill_zero(blurred_, CLPV_NEAR_LIGHT_PLANES * numbers);
  width_ = width, height_ = height;
}

Kernel& NearField::set_hits(Kernel& kernel, const ClpvView& view, bool fresh) {
  return kernel.set(view, points_, counts_, hits_, buffers_.vertices, buffers_.triangles,
                    buffers_.materials, buffers_.textures, buffers_.texels, cl_uint{fresh},
                    radiances_);
}

void NearField::light_hits(const Surface& camera, const Gatherer& gatherer,
                           const std::vector<ShadowedLight>& lights) {
  const ClpvView& view = camera.view;
  const cl::NDRange rays(items_along(session_, near_pixels(view.width, options_.step)),
                         tiles_down(near_rows(view.height, options_.step)), rays_of_tile());
  const cl::NDRange group(8, session_.device().lanes == 8 ? 1 : 8, 1);
  bool fresh = true;
  if (buffers_.emissive || lights.empty()) {
    set_hits(emit_, view, fresh).launch(rays, group);
    fresh = false;
  }
  for_each_shadow_map(lights, [&](const ShadowedLight& shadowed, cl_uint which) {
    add_shadow_map(set_hits(light_, view, fresh), shadowed, which).launch(rays, group);
    fresh = false;
  });
  if (!reflect_) return;
  set_hits(*reflect_, view, fresh);
  gatherer.add_radiance(*reflect_);
  reflect_->launch(rays, group);
}

void NearField::trace(const Surface& camera, const Gatherer& gatherer) {
  const ClpvView& view = camera.view;
  finish();
  reserve(view);
  const unsigned width = near_pixels(view.width, options_.step),
                 height = near_rows(view.height, options_.step);
  const cl::NDRange with_border(items_along(session_, pixel_plane_pitch(width)),
                                height + 2 * CLPV_PLANE_ROWS);
  PixelKernels& pixels = pixel_kernels(camera.points());
  pixels.first
      .set(view, camera.places(), camera.normal, gatherer.grids(), gatherer.cascades(), points_)
      .launch(with_border, pixel_group(session_));
  if (pixels.others) {
    pixels.others
        ->set(view, camera.places(), camera.normal, gatherer.grids(), gatherer.cascades(), points_)
        .launch(cl::NDRange(items_along(session_, width), near_pixels(view.height, options_.step)),
                pixel_group(session_));
  }
  // With eight lanes, a work-group has one work-item: node lists of several would not fit into the
  // first-level cache.
  const bool tiles = session_.device().lanes == 8;
  const cl::NDRange group = tiles ? cl::NDRange(1, 1, 1) : cl::NDRange(8, 8, 1);
  trace_
      .set(view, points_, directions_, nodes_, leaves_, buffers_.vertices, buffers_.triangles,
           buffers_.materials, buffers_.textures, buffers_.texels, distances_, counts_, hits_)
      .launch({items_along(session_, width), tiles_down(height), tiles ? 1 : rays_of_tile()}, group,
              Chain{tiles ? rays_of_tile() : 1});
}

void NearField::add(const Surface& camera, const Gatherer& gatherer,
                    const std::vector<ShadowedLight>& lights, Buffer& irradiance) {
  const ClpvView& view = camera.view;
  light_hits(camera, gatherer, lights);
  const cl::NDRange rows(items_along(session_, near_pixels(view.width, options_.step)),
                         near_rows(view.height, options_.step));
  near_.set(view, points_, directions_, distances_, radiances_, near_light_);
  gatherer.add_radiance(near_);
  near_.launch(rows, pixel_group(session_));
  blur_.set(view, points_, near_light_, blurred_).launch(rows, pixel_group(session_));
  widen_.set(view, points_, blurred_, near_light_).launch(rows, pixel_group(session_));
  pixel_kernels(camera.points())
      .add.set(view, camera.places(), camera.normal, points_, near_light_, irradiance)
      .launch(items_of(session_, view), pixel_group(session_));
}

}  // namespace clpv
