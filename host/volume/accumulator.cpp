// SPDX-License-Identifier: MIT
#include "volume/accumulator.hpp"

namespace clpv {
namespace {

// Texels of a row; on a CPU, images are no faster with 3-D work-groups.
constexpr std::size_t kLocalX = 64;

ProgramSource source_of(const VolumeShape& shape, Storage storage) {
  ProgramSource source{"volume/convert.cl"};
  add_coefficient_literals(source.literals, shape.coefficients);
  add_volume_literals(source.literals, shape.n, {Layout::image, storage});
  return source;
}

}  // namespace

VolumeFormat Accumulator::cells_format(const VolumeFormat& format) {
  return format.layout == Layout::image ? VolumeFormat{Layout::soa, format.storage} : format;
}

Volume& Accumulator::spare_of(const Volume& sum) {
  for (const auto& spare : spares_) {
    if (spare->shape() == sum.shape() && spare->format() == sum.format()) return *spare;
  }
  spares_.push_back(
      std::make_unique<Volume>(session_, sum.shape(), "spare volume of a sum", sum.format()));
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

PlaneStage::PlaneStage(Session& session, const VolumeShape& shape, Storage storage)
    : planes_(session, shape, "volume as planes", {Layout::soa, storage}),
      from_image_(session, source_of(shape, storage), "image_to_planes"),
      to_image_(session, source_of(shape, storage), "planes_to_image") {}

void PlaneStage::launch(Kernel& kernel, const Volume& from, const Volume& to) const {
  const std::size_t n = planes_.shape().n;
  const std::size_t channels = planes_.shape().channels;
  kernel.set(from.memory(), to.memory()).launch({n, n, n * channels}, {kLocalX, 1, 1});
}

void PlaneStage::load(const Volume& image) {
  launch(from_image_, image, planes_);
}

void PlaneStage::store(Volume& image) {
  launch(to_image_, planes_, image);
}

}  // namespace clpv
