// SPDX-License-Identifier: MIT
#include "pipeline/voxels/voxel_field.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "basis/bounce.hpp"
#include "kernels/shared/blockers.h"
#include "kernels/shared/reflectors.h"

namespace clpv {
namespace {

// Reach of triangles beyond a box of cells [cells]. Corner cells and cubes between centres are
// offset by half a cell, lit points along an axis by up to 0.683 (n_x (|n_x| + |n_y| + |n_z|) / 2);
// the rest is a margin for rounding.
constexpr double kReach = 0.7;
// Bases are this many grids apart; the base is constant while a cascade moves within that distance.
constexpr int kGridsApart = 4;
constexpr std::size_t kMaskGroup = 64;  // work-items per group
constexpr std::size_t kPoints = 64;     // points per cube between cell centres, one byte each
static_assert(kCellFaces == CLPV_CELL_FACES);

/// Returns the position of a grid. Its first cell is at least two grids from the base along each
/// axis, so that cell indices nearby are not negative.
ClpvRegion place_of(const ClpvGrid& grid) {
  ClpvRegion place{};
  place.cell = grid.cell;
  const double n = grid.n, apart = kGridsApart * n, cell = grid.cell;
  for (int a = 0; a < 3; ++a) {
    const double first = std::round(grid.origin[a] / cell);
    const double base = apart * std::floor((first - 2 * n) / apart);
    place.base[a] = base * cell;
    place.first[a] = first - base;
  }
  return place;
}

/// Returns the bounds of `box` extended by the reach of triangles [m].
Bounds reach_of(const ClpvRegion& region, const ClpvBox& box) {
  Bounds reach;
  for (int a = 0; a < 3; ++a) {
    const double low = region.first[a] + box.low[a] - kReach,
                 high = region.first[a] + box.high[a] + 1 + kReach;
    reach.lower[a] = region.base[a] + region.cell * low;
    reach.upper[a] = region.base[a] + region.cell * high;
  }
  return reach;
}

/// Returns the part of a box within cells [0, valid) along each axis; none if they do not
/// intersect.
std::optional<ClpvBox> within(ClpvBox box, int valid) {
  for (int a = 0; a < 3; ++a) {
    box.low[a] = std::max(box.low[a], 0);
    box.high[a] = std::min(box.high[a], valid - 1);
    if (box.low[a] > box.high[a]) return std::nullopt;
  }
  return box;
}

const ProgramSource kMasks{"voxels/voxel_masks.cl"};

bool meet(const Bounds& a, const Bounds& b) {
  return glm::all(glm::lessThanEqual(a.lower, b.upper)) &&
         glm::all(glm::lessThanEqual(b.lower, a.upper));
}

}  // namespace

std::size_t VoxelMaskShape::words_a_cascade() const {
  const std::size_t along = cells;
  return along * along * along * words;
}

VoxelField::VoxelField(Session& session, const SceneBuffers& scene, VoxelKind kind)
    : session_(session),
      scene_(scene),
      kind_(std::move(kind)),
      states_(kind_.shape.cascades),
      masks_(session.buffer(kind_.shape.bytes(), kind_.what)),
      clusters_(session.buffer(
          std::max<std::size_t>(scene.clusters->bounds().size(), 1) * sizeof(cl_uint),
          kind_.what + ": clusters")),
      voxelize_(session, kind_.program, kind_.kernel),
      move_(session, kMasks, "move_masks"),
      clear_(session, kMasks, "clear_masks") {
  if (!kind_.volume_kernel.empty())
    volume_.emplace(session, kind_.volume_program, kind_.volume_kernel);
  if (kind_.shape.valid == 0)
    session_.fill_zero(masks_, kind_.shape.bytes());  // no other code writes them
  if (kind_.shape.cascades > 1)
    spare_ =
        session.buffer(kind_.shape.words_a_cascade() * sizeof(cl_uint), kind_.what + ": moved");
}

void VoxelField::update(std::size_t cascade, const ClpvGrid& grid) {
  std::optional<State>& state = states_[slot(cascade)];
  const ClpvRegion place = place_of(grid);
  const ClpvRegion region = state ? stale_cells(*state, place) : whole(place);
  state.reset();  // in case the code below throws
  if (region.boxes > 0) {
    clear(cascade, region);
    list_clusters(region);
    voxelize(cascade, region);
  }
  state = State{place, scene_.clusters->instant()};
}

/// Sets the masks of the listed clusters' triangles.
void VoxelField::voxelize(std::size_t cascade, const ClpvRegion& region) {
  const unsigned step = std::max(kind_.max_triangles / CLPV_CLUSTER, 1u);
  for (cl_uint first = 0; first < near_; first += step) {
    const cl_uint count = std::min(near_ - first, step);
    voxelize_.set(region, clusters_, first, count, scene_.triangle_count, scene_.vertices,
                  scene_.triangles, scene_.materials);
    if (kind_.textured) voxelize_.add(scene_.textures, scene_.texels);
    voxelize_.add(masks_);
    if (kind_.indexed) voxelize_.add(slot(cascade));
    voxelize_.launch(cl::NDRange(std::size_t{count} * CLPV_CLUSTER), cl::NDRange(CLPV_CLUSTER));
  }
}

void VoxelField::update(std::size_t cascade, const ClpvGrid& grid, Volume& volume) {
  update(cascade, grid);
  Kernel& kernel = volume_.value().set(masks_);
  if (kind_.indexed) kernel.add(slot(cascade));
  const std::size_t cells = kind_.shape.cells;
  kernel.add(volume.memory())
      .launch(cl::NDRange(cells, cells, cells), cl::NDRange(kMaskGroup, 1, 1));
}

cl_uint VoxelField::slot(std::size_t cascade) const {
  return std::min(cascade, states_.size() - 1);
}

ClpvRegion VoxelField::whole(ClpvRegion place) const {
  const int last = kind_.shape.cells - 1;
  add_box(place, {{0, 0, 0}, {last, last, last}});
  return place;
}

/// Returns the cells whose voxel masks are stale. These are all cells if old and new grids share
/// none, if a grid moved and only one cascade is stored, or if more than one time step passed.
ClpvRegion VoxelField::stale_cells(const State& state, ClpvRegion place) const {
  if (place.cell != state.place.cell || !std::ranges::equal(place.base, state.place.base) ||
      scene_.clusters->instant() - state.instant > 1)
    return whole(place);
  for (int a = 0; a < 3; ++a) {
    place.moved[a] = place.first[a] - state.place.first[a];
    const bool movable = spare_.exists() && std::abs(place.moved[a]) < kind_.shape.valid;
    if (place.moved[a] != 0 && !movable) return whole(place);
  }
  add_new_cells(place);
  if (scene_.clusters->instant() != state.instant) add_moved(place);
  return place;
}

void VoxelField::add_new_cells(ClpvRegion& region) const {
  const int last = kind_.shape.valid - 1;
  for (int a = 0; a < 3; ++a) {
    const int moved = region.moved[a];
    ClpvBox slab{{0, 0, 0}, {last, last, last}};
    (moved > 0 ? slab.low : slab.high)[a] = moved > 0 ? last + 1 - moved : -moved - 1;
    if (moved != 0) add_box(region, slab);
  }
}

void VoxelField::add_moved(ClpvRegion& region) const {
  for (const Bounds& moved : scene_.clusters->moved()) {
    ClpvBox box;
    const double most = 2.0 * kind_.shape.cells;
    for (int a = 0; a < 3; ++a) {
      const auto cell = [&](float at, double reach) -> int {
        const double from_first = (double{at} - region.base[a]) / region.cell - region.first[a];
        return std::clamp(std::floor(from_first + reach), -most, most);
      };
      box.low[a] = cell(moved.lower[a], -kReach);
      box.high[a] = cell(moved.upper[a], kReach);
    }
    add_box(region, box);
  }
}

/// Adds a box to a region; if there are too many boxes, merges all into one.
void VoxelField::add_box(ClpvRegion& region, const ClpvBox& box) const {
  const std::optional<ClpvBox> inside = within(box, kind_.shape.valid);
  if (!inside) return;
  ClpvBox& all = region.all;
  if (region.boxes == 0) all = *inside;
  for (int a = 0; a < 3; ++a) {
    all.low[a] = std::min(all.low[a], inside->low[a]);
    all.high[a] = std::max(all.high[a], inside->high[a]);
  }
  if (region.boxes < CLPV_REGION_BOXES) {
    region.box[region.boxes++] = *inside;
  } else {
    region.box[0] = all, region.boxes = 1;
  }
}

/// Moves the masks that stay valid, and clears those to recompute.
void VoxelField::clear(std::size_t cascade, const ClpvRegion& region) {
  const std::size_t bytes = kind_.shape.words_a_cascade() * sizeof(cl_uint),
                    from = slot(cascade) * bytes;
  const std::size_t along = kind_.shape.cells;
  const auto words = static_cast<cl_int>(kind_.shape.words);
  const cl::NDRange cells(along, along, along), group(kMaskGroup, 1, 1);
  if (is_whole(region)) return session_.fill_zero(masks_, bytes, from);
  if (std::any_of(region.moved, region.moved + 3,
                  [](int cells_moved) { return cells_moved != 0; })) {
    move_.set(region, kind_.shape.cells, kind_.shape.valid, words, masks_, slot(cascade), spare_)
        .launch(cells, group);
    session_.copy(spare_, masks_, bytes, from);
  }
  clear_.set(region, kind_.shape.cells, words, masks_, slot(cascade)).launch(cells, group);
}

bool VoxelField::is_whole(const ClpvRegion& region) const {
  return region.boxes == 1 &&
         std::all_of(region.all.low, region.all.low + 3, [](int low) { return low == 0; }) &&
         std::all_of(region.all.high, region.all.high + 3,
                     [&](int high) { return high == kind_.shape.valid - 1; });
}

/// Lists the clusters of triangles in or near the region.
void VoxelField::list_clusters(const ClpvRegion& region) {
  std::vector<Bounds> reaches;
  for (unsigned b = 0; b < region.boxes; ++b) reaches.push_back(reach_of(region, region.box[b]));
  const std::vector<cl_uint> near = scene_.clusters->which([&](const Bounds& cluster) {
    return std::any_of(reaches.begin(), reaches.end(),
                       [&](const Bounds& reach) { return meet(cluster, reach); });
  });
  near_ = near.size();
  session_.write(clusters_, near);
}

VoxelKind blocker_masks(const SceneBuffers& scene, int grid, int cascades,
                        const VolumeFormat& format, bool only_masked) {
  VoxelKind kind{
      .what = "masks of triangles that block",
      .shape = {grid + 1, grid + 1, CLPV_BLOCKER_WORDS, static_cast<std::size_t>(cascades)},
      .max_triangles = 1u << 20,
      .program = {"voxels/blockers.cl"},
      .kernel = "voxelize_blockers",
      .volume_program = {"voxels/blocked_areas.cl"},
      .volume_kernel = "blocked_areas"};
  kind.program.literals.integer("CLPV_GRID", grid)
      .flag("CLPV_MASKED", scene.masked)
      .flag("CLPV_ONLY_MASKED", only_masked);
  add_volume_literals(kind.volume_program.literals, grid, format);
  add_coefficient_literals(kind.volume_program.literals, 3);
  return kind;
}

VoxelKind reflector_masks(const SceneBuffers& scene, int grid, const VolumeFormat& format,
                          bool white) {
  VoxelKind kind{.what = "sides of triangles that reflect",
                 .shape = {grid, grid, CLPV_CELL_FACES * CLPV_FACE_WORDS, 1},
                 .max_triangles = 1u << 18,
                 .program = {"voxels/reflectors.cl"},
                 .kernel = "voxelize_reflectors",
                 .indexed = false,
                 .volume_program = {"voxels/face_albedo.cl"},
                 .volume_kernel = "face_albedo"};
  kind.program.literals.integer("CLPV_GRID", grid)
      .flag("CLPV_MASKED", scene.masked)
      .flag("CLPV_TEXTURED", scene.textured)
      .flag("CLPV_COLOURED", scene.coloured)
      .flag("CLPV_WHITE", white);
  add_volume_literals(kind.volume_program.literals, grid, format);
  add_coefficient_literals(kind.volume_program.literals, kCellFaces);
  return kind;
}

VoxelKind visibility_masks(int grid, int cascades) {
  // One cube between centres for each cell except the last ones.
  const VoxelMaskShape shape{grid, grid - 1, kPoints / sizeof(cl_uint),
                             static_cast<std::size_t>(cascades)};
  VoxelKind kind{.what = "cells occluded by triangles",
                 .shape = shape,
                 .max_triangles = 1u << 20,
                 .program = {"voxels/visibility.cl"},
                 .kernel = "occlude_cells",
                 .textured = false};
  kind.program.literals.integer("CLPV_GRID", grid);
  return kind;
}

std::size_t visibility_bytes(int grid) {
  return visibility_masks(grid, 1).shape.bytes();
}

}  // namespace clpv
