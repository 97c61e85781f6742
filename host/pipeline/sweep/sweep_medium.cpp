// SPDX-License-Identifier: MIT
#include "pipeline/sweep/sweep_medium.hpp"

#include <algorithm>

#include "basis/sweep.hpp"
#include "pipeline/sweep/sweep_literals.hpp"
#include "pipeline/sweep/sweep_tables.hpp"

namespace clpv {
namespace {

constexpr std::size_t kSourceVolumes = 3 * kSweepBins;

ProgramSource scattering_program(const SweepVolumes& volumes, const ClpvMedium& medium) {
  ProgramSource source =
      volumes.program("sweep/sweep_medium.cl", scattering_literals(double{medium.anisotropy}));
  source.literals.flag("CLPV_MEDIUM", true);
  return source;
}

std::vector<cl_float4> mean_directions() {
  std::vector<cl_float4> directions;
  for (const SweepBin& bin : sweep_bins(1)) {
    const glm::vec3 w(bin.directions.front().w);
    directions.push_back({{w.x, w.y, w.z, 0}});
  }
  return directions;
}

}  // namespace

bool scatters(const std::optional<ClpvMedium>& medium) {
  return medium && std::ranges::any_of(medium->scattering, [](float sigma) { return sigma > 0; });
}

SweepMedium::SweepMedium(Session& session, const SweepVolumes& volumes, const ClpvMedium& medium,
                         int grid, std::size_t cascades)
    : session_(session),
      volumes_(volumes),
      medium_(medium),
      scatter_lights_(session, scattering_program(volumes, medium), "scatter_lights"),
      scatter_swept_(session, scattering_program(volumes, medium), "scatter_swept"),
      bins_(session.upload(mean_directions(), "mean directions of bins")),
      of_lights_(volumes.make(kSourceVolumes, "light of lights that the medium scatters")) {
  const std::size_t numbers = 3 * bordered_pitch(grid) + CLPV_SWEEP_FIRST;
  for (std::size_t c = 0; c < cascades; ++c)
    inside_.push_back(zeroed_buffer(session, numbers * sizeof(float), "cells in the medium"));
}

void SweepMedium::place(std::size_t cascade, const ClpvGrid& grid) {
  session_.write(inside_[cascade], cells_in_medium(medium_, grid));
}

void SweepMedium::scatter_lights(const ClpvGrid& grid, const std::vector<ShadowedLight>& lights) {
  if (!scatters(medium_)) return;
  session_.fill_zero(of_lights_, of_lights_.bytes());
  for_each_shadow_map(lights, [&](const ShadowedLight& shadowed, cl_uint which) {
    scatter_lights_.set(grid);
    add_shadow_map(scatter_lights_, shadowed, which).add(bins_, of_lights_);
    volumes_.launch(scatter_lights_, 1);
  });
}

void SweepMedium::scatter_swept(const Buffer& swept) {
  if (!of_swept_.exists())
    of_swept_ = volumes_.make(kSourceVolumes, "light that the medium scatters");
  scatter_swept_.set(medium_, of_lights_, swept, of_swept_);
  volumes_.launch(scatter_swept_, 3);
}

void SweepMedium::add_to(Kernel& sweep, std::size_t cascade, bool swept) const {
  sweep.add(inside_[cascade], swept ? of_swept_ : of_lights_);
}

}  // namespace clpv
