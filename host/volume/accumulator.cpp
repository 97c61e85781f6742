// SPDX-License-Identifier: MIT
#include "volume/accumulator.hpp"

namespace clpv {

VolumeFormat Accumulator::cells_format(const VolumeFormat& format) {
  return updates_in_place(format) ? format : planes_format(format.storage);
}

std::size_t Accumulator::spare_bytes(const VolumeFormat& format, const VolumeShape& shape) {
  return updates_in_place(format) ? 0 : stored_bytes(format, shape);
}

std::size_t Accumulator::cells_bytes(const VolumeFormat& format, const VolumeShape& shape) {
  return updates_in_place(format) ? 0 : stored_bytes(cells_format(format), shape);
}

Volume& Accumulator::spare_of(const Volume& sum) {
  for (const auto& spare : spares_) {
    if (spare->shape() == sum.shape() && spare->format() == sum.format()) return *spare;
  }
  spares_.push_back(std::make_unique<Volume>(session_, sum.shape(), "spare volume of a sum", sum.format()));
  return *spares_.back();
}

PlaneStage& Accumulator::planes_of(const Volume& sum) {
  const VolumeFormat format = cells_format(sum.format());
  for (const auto& stage : planes_) {
    if (stage->planes().shape() == sum.shape() && stage->planes().format() == format) return *stage;
  }
  planes_.push_back(std::make_unique<PlaneStage>(session_, sum.shape(), format.storage));
  return *planes_.back();
}

}  // namespace clpv
