// SPDX-License-Identifier: MIT
#include "commands/sequence_stability.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <utility>

#include "bench/statistics.hpp"
#include "pathtracer/path_tracer.hpp"
#include "support/fingerprint.hpp"

namespace clpv {
namespace {

using nlohmann::json;

constexpr int kSchema = 1;

std::uint64_t content_of(const Scene& scene, const Camera& camera) {
  Fingerprint print;
  add_moving(print, scene);
  for (const Light& light : scene.lights_for(camera)) print.add(std::vector{light.data});
  return print.value();
}

std::vector<int> moved(const std::vector<ClpvGrid>& before, const std::vector<ClpvGrid>& now) {
  std::vector<int> cascades;
  for (std::size_t c = 0; c < now.size(); ++c) {
    if (!std::equal(now[c].origin, now[c].origin + 3, before[c].origin))
      cascades.push_back(static_cast<int>(c));
  }
  return cascades;
}

std::vector<float> four_a_pixel(const std::vector<glm::vec3>& pixels) {
  std::vector<float> values;
  for (const glm::vec3& p : pixels) values.insert(values.end(), {p.x, p.y, p.z, 0});
  return values;
}

json number_or_null(const std::optional<double>& value) {
  return value ? json(*value) : json(nullptr);
}

}  // namespace

void SequenceStability::add(int number, double seconds, const Scene& scene, const Camera& camera) {
  Seen now{read_surface(session_, frame_.seen()), frame_.read(Show::irradiance), frame_.light().grids,
           content_of(scene, camera)};
  if (before_) steps_.push_back(step(number, seconds, now, scene, camera));
  before_ = std::move(now);
}

std::optional<double> SequenceStability::noise_of(const Scene& scene, const Camera& camera,
                                                  const std::vector<bool>& counted) const {
  if (traced_ == 0) return {};
  const auto traced = [&](std::uint64_t seed) {
    reference::PathTracerOptions options;
    options.samples = traced_, options.seed = seed;
    return four_a_pixel(
        reference::trace_paths(scene, scene.lights_for(camera), before_->surfaces.view, options).irradiance);
  };
  return change_of_light(counted, traced(1), traced(2)).mean;
}

SequenceStability::Step SequenceStability::step(int number, double seconds, const Seen& now,
                                                const Scene& scene, const Camera& camera) {
  const std::vector<bool> counted = still_seen(before_->surfaces, now.surfaces);
  const auto surfaces = std::ranges::count_if(before_->surfaces.depth, [](float depth) { return depth > 0; });
  const LightChange change =
      change_of_light(counted, before_->irradiance, frame_.irradiance_on(before_->surfaces));
  return {number,
          seconds,
          now.content == before_->content,
          moved(before_->grids, now.grids),
          surfaces > 0 ? static_cast<double>(change.points) / static_cast<double>(surfaces) : 0.0,
          change,
          noise_of(scene, camera, counted)};
}

json SequenceStability::to_json(const json& about) const {
  json all = about, frames = json::array();
  std::vector<double> inside, across;
  for (const Step& step : steps_) {
    frames.push_back({{"frame", step.frame},
                      {"time", step.seconds},
                      {"still", step.still},
                      {"cascades_moved", step.moved},
                      {"seen", step.seen},
                      {"change", number_or_null(step.change.mean)},
                      {"change_p95", number_or_null(step.change.p95)},
                      {"traced", number_or_null(step.noise)}});
    if (step.still && step.change.mean) (step.moved.empty() ? inside : across).push_back(*step.change.mean);
  }
  all.update({{"schema", kSchema}, {"traced_spp", traced_}, {"frames", std::move(frames)}});
  for (const auto& [name, samples] : {std::pair("inside_cells", inside), std::pair("across_cells", across)}) {
    const bench::Statistics figures = bench::statistics_of(samples);
    all["summary"][name] = {
        {"frames", samples.size()}, {"median", figures.median}, {"p95", figures.p95}, {"worst", figures.max}};
  }
  return all;
}

}  // namespace clpv
