// SPDX-License-Identifier: MIT
#include "pipeline/sweep/bounce.hpp"

#include "basis/bounce.hpp"
#include "codegen/sweep_source.hpp"

namespace clpv {
namespace {

constexpr int kChannels = 3;

}  // namespace

Bouncer::Bouncer(Session& session, const Basis& basis, const SweepOptions& options, bool series)
    : volumes_(session, options.grid, options.format),
      reflectors_(options.parts.size()),
      inject_reflected_(session, volumes_.program("sweep/bounce.cl", bounce_source_text(basis)),
                        "inject_reflected") {
  if (!series) return;
  const ProgramSource program = volumes_.program("sweep/bounce.cl", bounce_source_text(basis));
  inject_unit_.emplace(session, program, "inject_unit");
  extend_series_.emplace(session, program, "extend_series");
  inject_series_.emplace(session, program, "inject_series");
  inject_interpolated_.emplace(session, program, "inject_interpolated");
  series_volume_ =
      std::make_unique<Volume>(session, VolumeShape{options.grid, kCellFaces, kChannels},
                               "series of bounces", options.format);
  for (std::size_t coarser = 1; coarser < options.parts.size(); ++coarser)
    incident_.push_back(
        volumes_.make_bordered(kChannels * kCellFaces, "incident flux of a coarser cascade"));
}

void Bouncer::set_reflectors(std::size_t cascade, const Volume& reflectors) {
  reflectors_[cascade] = &reflectors;
  if (cascade + 1 == reflectors_.size()) series_ = &reflectors;
}

void Bouncer::inject_unit(Volume& bounced) {
  inject_unit_->set(series_->memory(), bounced.memory());
  volumes_.launch(*inject_unit_, kChannels);
}

void Bouncer::extend_series(const Buffer& swept) {
  extend_series_->set(swept, reflectors_.back()->memory(), series_volume_->memory());
  volumes_.launch(*extend_series_, kChannels);
  series_ = series_volume_.get();
}

void Bouncer::inject_reflected(std::size_t cascade, const Buffer& swept, float share,
                               const Volume& injected, Volume& bounced) {
  inject_reflected_.set(swept, reflectors_[cascade]->memory(), injected.memory(), share,
                        bounced.memory());
  volumes_.launch(inject_reflected_, kChannels);
}

void Bouncer::inject_series(const Buffer& first_swept, const Buffer& second_swept,
                            const Volume& injected, Volume& bounced) {
  inject_series_->set(first_swept, second_swept, reflectors_.back()->memory(), series_->memory(),
                      injected.memory(), bounced.memory());
  volumes_.launch(*inject_series_, kChannels);
}

void Bouncer::inject_interpolated(std::size_t cascade, const std::array<int, 3>& offset,
                                  const Volume& injected, Volume& bounced) {
  inject_interpolated_->set(incident_[cascade], offset[0], offset[1], offset[2],
                            reflectors_[cascade]->memory(), injected.memory(), bounced.memory());
  volumes_.launch(*inject_interpolated_, kChannels);
}

}  // namespace clpv
