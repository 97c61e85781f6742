// SPDX-License-Identifier: MIT
#include "pipeline/sweep/sweep_volumes.hpp"

#include <algorithm>
#include <cstdint>
#include <limits>
#include <utility>

#include "kernels/shared/sweep.h"
#include "support/error.hpp"

namespace clpv {

Buffer zeroed_buffer(Session& session, std::size_t bytes, const char* what) {
  const std::size_t words = (bytes + sizeof(cl_uint) - 1) / sizeof(cl_uint) * sizeof(cl_uint);
  Buffer buffer = session.buffer(words, what);
  session.fill_zero(buffer, words);
  return buffer;
}

SweepVolumes::SweepVolumes(Session& session, int grid, const VolumeFormat& format)
    : session_(session), grid_(grid), format_(format), tile_(lanes_of(session.device(), format)) {}

ProgramSource SweepVolumes::program(const char* file, Literals literals) const {
  ProgramSource source{file, std::move(literals)};
  add_volume_literals(source.literals, grid_, format_, tile_);
  return source;
}

void SweepVolumes::launch(Kernel& kernel, int channels) const {
  const std::size_t tiles = (grid_ + tile_ - 1) / tile_;
  const std::size_t slices = grid_ * channels;
  kernel.launch({tiles, tiles, slices}, {tile_ == 1 ? std::min(tiles, kRowGroup) : 1, 1, 1});
}

Buffer SweepVolumes::make(std::size_t count, const char* what) const {
  constexpr std::size_t kMost = std::numeric_limits<std::int32_t>::max();
  const std::size_t numbers = count * sweep_volume_size(grid_);
  if (numbers > kMost)
    throw TooLarge(
        Error(ExitCode::device, "unsupported: {} of {} numbers; kernels address at most {}", what,
              numbers, kMost),
        static_cast<double>(kMost) / static_cast<double>(numbers));
  return zeroed_buffer(session_, numbers * number_bytes(format_.storage), what);
}

}  // namespace clpv
