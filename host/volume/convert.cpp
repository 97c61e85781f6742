// SPDX-License-Identifier: MIT
#include "volume/convert.hpp"

#include "codegen/cell_macros.hpp"

namespace clpv {
namespace {

constexpr std::size_t kLocalX = 64;  // texels of a row; an image is not faster by blocks on a CPU

ProgramSource source_of(const VolumeShape& shape, Storage storage) {
  ProgramSource source{"convert.cl", {}, coefficient_macros(shape.coefficients)};
  source.literals.integer("CLPV_GRID", shape.n);
  add_format_literals(source.literals, {Layout::image, storage});
  return source;
}

}  // namespace

PlaneStage::PlaneStage(Session& session, const VolumeShape& shape, Storage storage)
    : planes_(session, shape, "volume as planes", planes_format(storage)),
      from_image_(session, source_of(shape, storage), "image_to_planes"),
      to_image_(session, source_of(shape, storage), "planes_to_image") {}

void PlaneStage::launch(Kernel& kernel, const Volume& from, const Volume& to) const {
  const std::size_t n = planes_.shape().n;
  const std::size_t channels = planes_.shape().channels;
  kernel.set(from.memory(), to.memory()).launch({n, n, n * channels}, {kLocalX, 1, 1});
}

void PlaneStage::take(const Volume& image) {
  launch(from_image_, image, planes_);
}

void PlaneStage::give(Volume& image) {
  launch(to_image_, planes_, image);
}

}  // namespace clpv
