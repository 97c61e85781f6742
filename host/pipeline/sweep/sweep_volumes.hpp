// SPDX-License-Identifier: MIT
// Allocates volumes of planes and launches their tile kernels (kernels/sweep/sweep_tiles.h); shared
// by the sweep stages.
#pragma once

#include <string>

#include "device/kernel.hpp"
#include "device/session.hpp"
#include "volume/volume_format.hpp"

namespace clpv {

/// Volumes of planes for a grid of `grid` cells along each axis, in the storage of `format`.
class SweepVolumes {
 public:
  SweepVolumes(Session& session, int grid, const VolumeFormat& format);

  /// Program with a work-item per tile; its literals are grid, lanes, layout and storage.
  ProgramSource program(const char* file, std::string generated) const;
  int lanes() const { return tile_; }  ///< cells along the edges of a tile

  /// Launches a kernel over the tiles of all slices and `channels` channels.
  void launch(Kernel& kernel, int channels) const;

  /// Allocates `count` zeroed volumes. Throws Error(device) "unsupported: ..." for more than
  /// kernels can address.
  Buffer make(std::size_t count, const char* what) const;

 private:
  Session& session_;
  int grid_;
  VolumeFormat format_;
  int tile_;
};

/// Returns a zeroed buffer of at least `bytes`. Errors as in Session::buffer().
Buffer zeroed_buffer(Session& session, std::size_t bytes, const char* what);

inline constexpr std::size_t kRowGroup = 64;  ///< work-items of a row in a work-group

}  // namespace clpv
