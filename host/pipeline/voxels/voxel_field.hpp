// SPDX-License-Identifier: MIT
// Incremental voxelisation: recomputes voxel masks only in cells that are new to a cascade or where
// triangles moved (kernels/voxels/voxel_masks.cl).
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "device/kernel.hpp"
#include "device/session.hpp"
#include "kernels/shared/grid.h"
#include "kernels/shared/region.h"
#include "pipeline/raster/scene_buffers.hpp"
#include "volume/volume.hpp"

namespace clpv {

/// Shape of a cascade's masks: 32-bit words, a fixed number per cell, cells along x first.
struct VoxelMaskShape {
  int cells;  ///< along each axis
  int valid;  ///< number of leading cells along each axis that may hold masks; the others hold
              ///< zeros
  std::size_t words;     ///< words per cell
  std::size_t cascades;  ///< number of stored cascades; 1: masks of the last updated cascade only

  std::size_t words_a_cascade() const;
  std::size_t bytes() const { return words_a_cascade() * cascades * sizeof(cl_uint); }
};

/// Kind of masks that triangles set in the cells of cascades: blocker_masks(), reflector_masks() or
/// visibility_masks().
struct VoxelKind {
  std::string what;  ///< for errors
  VoxelMaskShape shape;
  unsigned max_triangles;  ///< in one launch, since larger launches take seconds on some devices
  /// Kernel that sets masks of a region's cells from triangles in any order. Its arguments are the
  /// region, the clusters (triangle_number of kernels/voxels/region.h), the scene's triangles, its
  /// textures if `textured`, the masks, and the index of the cascade's masks if `indexed`.
  ProgramSource program;
  std::string kernel;
  bool textured = true, indexed = true;
  /// Kernel that computes a volume from the masks, and from their index if `indexed`; empty: none.
  ProgramSource volume_program = {};
  std::string volume_kernel = {};
};

/// Stage `blockers` (kernels/voxels/blockers.cl; docs/method.md, 'Blockers'): geometry volumes of
/// areas (Blocking::areas): (grid + 1)^3 samples of 3 numbers of `format`, one channel. Each is the
/// share of a square that triangles cover. Overlapping triangles count once. `only_masked`: those
/// of masked materials alone.
VoxelKind blocker_masks(const SceneBuffers& scene, int grid, int cascades,
                        const VolumeFormat& format, bool only_masked = false);

/// Stage `reflectors` (kernels/voxels/reflectors.cl; docs/method.md, 'More bounces'): reflectance
/// of the faces of light cells: kCellFaces numbers in [0, 1] of `format` per channel, for +x, -x,
/// +y, -y, +z, -z. Each is the covered share of the face times mean albedo; further channels:
/// kernels/voxels/face_albedo.cl. `white`: no albedo, and backs count only where the material is
/// double-sided. Masks are those of the last cascade: sums of integers, whose order does not
/// matter.
VoxelKind reflector_masks(const SceneBuffers& scene, int grid, const VolumeFormat& format,
                          bool white = false);

/// Stage `visibility` (kernels/voxels/visibility.cl; docs/method.md, 'Gathering'): occlusion bits
/// of the eight cells around each of 64 points in every cube between cell centres. Each point has
/// one byte, in the order of kernels/voxels/visibility.cl. No volume follows from them.
VoxelKind visibility_masks(int grid, int cascades);

/// Size of one cascade's bits of visibility_masks() [bytes].
std::size_t visibility_bytes(int grid);

/// Masks that triangles set in the cells of cascades, and the volumes that follow from them.
/// Deterministic: the order of triangles does not matter.
class VoxelField {
 public:
  /// `scene` must not change except by upload_moving(). Throws Error(run_time) if device memory
  /// does not suffice.
  VoxelField(Session& session, const SceneBuffers& scene, VoxelKind kind);

  /// Updates a cascade's masks for the position of `grid` and the current scene.
  void update(std::size_t cascade, const ClpvGrid& grid);
  /// The same, and overwrites `volume`.
  void update(std::size_t cascade, const ClpvGrid& grid, Volume& volume);

  /// Masks of all stored cascades, finest first.
  const Buffer& masks() const { return masks_; }

 private:
  /// Index of a cascade's masks among the stored cascades.
  cl_uint slot(std::size_t cascade) const;
  struct State {  ///< inputs of a cascade's masks
    ClpvRegion place;
    unsigned instant;
  };
  void voxelize(std::size_t cascade, const ClpvRegion& region);
  ClpvRegion stale_cells(const State& state, ClpvRegion place) const;
  void add_new_cells(ClpvRegion& region) const;
  void add_moved(ClpvRegion& region) const;
  void add_box(ClpvRegion& region, const ClpvBox& box) const;
  ClpvRegion whole(ClpvRegion place) const;
  bool is_whole(const ClpvRegion& region) const;
  void clear(std::size_t cascade, const ClpvRegion& region);
  void list_clusters(const ClpvRegion& region);

  Session& session_;
  SceneBuffers scene_;
  VoxelKind kind_;
  unsigned near_ = 0;  ///< number of listed clusters
  std::vector<std::optional<State>> states_;
  Buffer masks_, spare_, clusters_;
  Kernel voxelize_, move_, clear_;
  std::optional<Kernel> volume_;
};

}  // namespace clpv
