#include "pipeline/convert.hpp"

#include "device/arguments.hpp"

namespace clpv {
namespace {

constexpr std::size_t kLocalX = 64;  // texels of a row; an image is not faster by blocks on a CPU

}  // namespace

PlaneStage::PlaneStage(Session& session, const VolumeShape& shape, Storage storage)
    : session_(session), planes_(session, shape, "volume as planes", {Layout::soa, storage}) {
  ProgramSource source{"convert.cl", {}, coefficient_macros(shape.coefficients)};
  source.literals["CLPV_GRID"] = std::to_string(shape.n);
  add_format_literals(source.literals, {Layout::image, storage});
  from_image_ = session.kernel(source, "image_to_planes");
  to_image_ = session.kernel(source, "planes_to_image");
}

void PlaneStage::launch(cl::Kernel& kernel, const Volume& from, const Volume& to) {
  set_arguments(kernel, from.memory(), to.memory());
  const auto n = static_cast<std::size_t>(planes_.shape().n);
  const auto channels = static_cast<std::size_t>(planes_.shape().channels);
  session_.launch(kernel, {n, n, n * channels}, {kLocalX, 1, 1});
}

void PlaneStage::take(const Volume& image) {
  launch(from_image_, image, planes_);
}

void PlaneStage::give(Volume& image) {
  launch(to_image_, planes_, image);
}

}  // namespace clpv
