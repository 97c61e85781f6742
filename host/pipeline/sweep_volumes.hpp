// SPDX-License-Identifier: MIT
// Volumes of planes, and the kernels that go over them a tile at a time (kernels/sweep.h): what the stages round a sweep share.
#pragma once

#include <string>

#include "device/kernel.hpp"
#include "device/session.hpp"
#include "volume/volume_format.hpp"

namespace clpv {

/// Of a grid of `grid` cells along each axis; their numbers are of `format`'s storage.
class SweepVolumes {
 public:
  SweepVolumes(Session& session, int grid, const VolumeFormat& format);

  /// A program whose work-items are tiles: its literals name grid, lanes, layout and storage.
  ProgramSource program(const char* file, std::string generated) const;
  /// Over the tiles of all slices, of `channels` channels.
  void launch(Kernel& kernel, int channels) const;

  /// `count` of them, zeroed; and of those with a border. Throws Error(device) "unsupported: ..." for more than kernels can address.
  Buffer make(std::size_t count, const char* what) const;
  Buffer make_bordered(std::size_t count, const char* what) const;

 private:
  Session& session_;
  int grid_;
  VolumeFormat format_;
  int tile_;  ///< cells along the edges of a tile
};

/// Zeroed, of at least `bytes`. Errors as of Session::buffer().
Buffer zeroed_buffer(Session& session, std::size_t bytes, const char* what);

inline constexpr std::size_t kRowGroup = 64;  ///< work-items of a row, on devices of many

}  // namespace clpv
