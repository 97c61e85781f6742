// SPDX-License-Identifier: MIT
#include "pipeline/sweep/bounce.hpp"

#include <numbers>

#include "basis/bounce.hpp"
#include "kernels/shared/reflectors.h"
#include "pipeline/sweep/sweep_literals.hpp"
#include "pipeline/voxels/voxel_field.hpp"

namespace clpv {
namespace {

constexpr int kChannels = 3;

}  // namespace

Bouncer::Bouncer(Session& session, const Basis& basis, const SweepOptions& options, bool series)
    : volumes_(session, options.grid, options.format),
      inject_flux_(session, volumes_.program("sweep/bounce.cl", bounce_literals(basis)),
                   "inject_flux") {
  if (options.bounces == Bounces::one) return;
  const ProgramSource program = volumes_.program("sweep/bounce.cl", bounce_literals(basis));
  normalise_reflectors_.emplace(session, program, "normalise_reflectors");
  inject_reflected_.emplace(session, program, "inject_reflected");
  for (std::size_t c = 0; c < options.parts.size(); ++c)
    reflectors_.emplace_back(session,
                             VolumeShape{options.grid, kCellFaces, CLPV_REFLECTOR_CHANNELS},
                             "reflectors of bounces", options.format);
  if (!series) return;
  reflect_returned_.emplace(session, program, "reflect_returned");
  sum_series_.emplace(session, program, "sum_series");
  inject_series_.emplace(session, program, "inject_series");
  const VolumeShape shape{options.grid, kCellFaces, kChannels};
  for (std::size_t c = 0; c < options.parts.size(); ++c)
    series_.emplace_back(session, VolumeShape{options.grid, kCellFaces, CLPV_SERIES_CHANNELS},
                         "series of bounces", options.format);
  returned_ = std::make_unique<Volume>(session, shape, "returned flux", options.format);
}

void Bouncer::inject_flux(const Volume& flux, const Volume& reflectors, SweepSources& sources) {
  inject_flux_.set(flux.memory(), reflectors.memory(), cl_int{0}, cl_int{1}, 1.0f,
                   sources.coefficients, sources.lit);
  volumes_.launch(inject_flux_, 1);
}

void Bouncer::inject_white(const Volume& reflectors, SweepSources& sources) {
  inject_flux_.set(reflectors.memory(), reflectors.memory(), cl_int{CLPV_REFLECTOR_WHITE},
                   cl_int{0}, std::numbers::pi_v<float>, sources.coefficients, sources.lit);
  volumes_.launch(inject_flux_, 1);
}

const Volume& Bouncer::set_reflectors(std::size_t cascade, const Buffer& swept,
                                      const Volume& reflectors) {
  normalise_reflectors_->set(swept, reflectors.memory(), std::numbers::pi_v<float>,
                             reflectors_[cascade].memory());
  volumes_.launch(*normalise_reflectors_, CLPV_REFLECTOR_CHANNELS);
  return reflectors_[cascade];
}

const Volume& Bouncer::reflect_returned(std::size_t cascade, const Buffer& swept) {
  reflect_returned_->set(swept, reflectors_[cascade].memory(), returned_->memory());
  volumes_.launch(*reflect_returned_, kChannels);
  return *returned_;
}

void Bouncer::sum_series(std::size_t cascade, const Buffer& swept) {
  sum_series_->set(swept, reflectors_[cascade].memory(), returned_->memory(),
                   series_[cascade].memory());
  volumes_.launch(*sum_series_, kChannels);
}

void Bouncer::inject_reflected(std::size_t cascade, const Buffer& swept, const Volume& injected,
                               SweepSources& sources, bool relaxed) {
  const Volume& reflectance = (relaxed ? series_ : reflectors_)[cascade];
  inject_reflected_->set(swept, reflectors_[cascade].memory(), reflectance.memory(),
                         cl_int{relaxed ? CLPV_SERIES_FIRST : 0}, injected.memory(),
                         sources.coefficients, sources.lit);
  volumes_.launch(*inject_reflected_, 1);
}

void Bouncer::inject_series(std::size_t cascade, const Buffer& first_swept,
                            const Buffer& second_swept, const Volume& injected,
                            SweepSources& sources) {
  inject_series_->set(first_swept, second_swept, reflectors_[cascade].memory(),
                      series_[cascade].memory(), injected.memory(), sources.coefficients,
                      sources.lit);
  volumes_.launch(*inject_series_, 1);
}

}  // namespace clpv
