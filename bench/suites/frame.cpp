// SPDX-License-Identifier: MIT
// Suite `frame`: whole frames along a camera path, and the time of each stage, with and without
// cached results.
#include <fmt/format.h>

#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

#include "bench/suites.hpp"
#include "options/render_options.hpp"
#include "support/named_enum.hpp"
#include "times/frame_times.hpp"
#include "verify/check.hpp"

namespace clpv {
namespace bench {

/// Results that each repetition recomputes besides the camera's view.
enum class Recompute {
  light,  ///< all lighting, as if the lights had changed; blockers and visibility only of moved
          ///< cascades
  everything,  ///< no cached results
  nothing,     ///< no lighting: the camera turns in a static scene with static lights
};

}  // namespace bench

template <>
inline constexpr auto kNames<bench::Recompute> = name_list("light", "everything", "nothing");

}  // namespace clpv

namespace clpv::bench {
namespace {

constexpr int kPathFrames = 24;
// Amplitudes of turn [rad] and sway [m], one period per path.
constexpr double kTurn = 0.6, kSway = 0.5;

/// The camera of a frame on a closed path of kPathFrames: it turns and sways left and right.
SceneCamera path_camera(SceneCamera camera, int frame, double sway) {
  const double phase = 2 * 3.14159265358979 * frame / kPathFrames;
  const glm::mat4 turn =
      glm::rotate(glm::mat4(1.0f), static_cast<float>(kTurn * std::sin(phase)), glm::vec3(0, 1, 0));
  camera.forward = glm::vec3(turn * glm::vec4(camera.forward, 0));
  camera.up = glm::vec3(turn * glm::vec4(camera.up, 0));
  const glm::vec3 right = glm::cross(camera.forward, camera.up);
  camera.eye += right * static_cast<float>(sway * std::sin(phase));
  return camera;
}

/// Frames rendered along a camera path, and their stage times.
struct FrameSequence {
  std::shared_ptr<const SceneData> scene;
  SceneCamera start;
  Recompute recompute;
  Frame frame;
  int next = 0;
  bool warm = false;
  FrameTimes times;

  FrameSequence(Session& session, std::shared_ptr<const SceneData> rendered,
                const std::string& camera, const RenderOptions& options, Recompute recomputed)
      : scene(std::move(rendered)),
        start(scene->camera(camera)),
        recompute(recomputed),
        frame(session, *scene, options) {}

  /// The camera of frame `number`. With Recompute::nothing it does not sway, so that cascades do
  /// not move.
  SceneCamera camera(int number) const {
    return path_camera(start, number, recompute == Recompute::nothing ? 0 : kSway);
  }

  void invalidate() {
    switch (recompute) {
      case Recompute::light:
        return frame.invalidate_light();
      case Recompute::everything:
        return frame.invalidate();
      case Recompute::nothing:
        return;
    }
  }

  void add(const std::vector<StageTime>& stages) {
    if (warm) times.add(stages);  // skips the warm-up, which compiles
    warm = true;
  }
};

/// Renders the last frame again after another one, without cached results. Its pixels must be
/// identical.
Deviation compare_uncached(FrameSequence& sequence, Session& session) {
  const std::vector<float> timed = sequence.frame.read(Show::full);
  sequence.frame.render(sequence.camera(sequence.next + kPathFrames / 2));
  sequence.frame.invalidate();
  sequence.frame.render(sequence.camera(sequence.next - 1));
  session.queue().finish();
  const std::vector<float> uncached = sequence.frame.read(Show::full);
  const verify::WorstError worst = verify::worst_difference(
      uncached.size(), [&](std::size_t i) { return double{timed[i]}; },
      [&](std::size_t i) { return double{uncached[i]}; });
  if (worst.value == 0) return {0, 0, {}};
  return {worst.value, 0,
          fmt::format("pixel {} channel {}: {:.7g}, without cached results {:.7g}", worst.at / 4,
                      worst.at % 4, timed[worst.at], uncached[worst.at])};
}

Job frame_job(Session& session, const SuiteOptions& options, const RenderOptions& render,
              Recompute recompute) {
  const auto sequence =
      std::make_shared<FrameSequence>(session, options.scene, options.camera, render, recompute);
  Job job;
  job.own_stages = true;
  job.reset = [sequence] { sequence->invalidate(); };
  job.run = [sequence] { sequence->frame.render(sequence->camera(sequence->next++)); };
  job.after_run = [sequence](const std::vector<StageTime>& times) { sequence->add(times); };
  job.more_rows = [sequence](const Row& row) { return pass_rows(sequence->times, row); };
  job.count = [&session] { return session.timeline().host(); };
  job.compare = [sequence, &session] { return compare_uncached(*sequence, session); };
  return job;
}

Case frame_case(Session& session, const SuiteOptions& options, PresetName preset,
                const std::string& basis, Recompute recompute) {
  RenderOptions render;
  apply_preset(render, preset);
  render.basis = basis;
  render.cascades = options.settings.cascades, render.cascade_size = options.settings.cascade_size;
  Problem problem;
  problem.options = render;
  problem.options.lobe = LobeKind::exact;  // the row's name has the preset in place of the lobes
  problem.options.lobe_time = LobeTime::host;
  Case result;
  result.row = make_row("frame", "frame", problem,
                        fmt::format("/{}/recompute:{}", name_of(preset), clpv::name_of(recompute)));
  result.row.preset = name_of(preset);
  result.row.recompute = clpv::name_of(recompute);
  result.make = [&session, options, render, recompute] {
    return frame_job(session, options, render, recompute);
  };
  return result;
}

std::string frame_table(const std::vector<Row>& rows) {
  std::string text = fmt::format("{:<67} {:>10} {:>9} {:>9} {:>9} {:>7}\n", "row", "median ms",
                                 "p95", "max", "mad", "fps");
  for (const Row& row : rows) {
    text += fmt::format("{:<67} {:>10.2f} {:>9.2f} {:>9.2f} {:>9.2f} {:>7}{}\n", row.name,
                        row.times.median, row.times.p95, row.times.max, row.times.mad,
                        row.stage == "frame" ? fmt::format("{:.1f}", 1e3 / row.times.median) : "",
                        row.status == Status::wrong ? "  WRONG" : "");
  }
  return text;
}

}  // namespace

Suite frame_suite() {
  return {
      "frame",
      "whole frames along a camera path: frames per second, median, 95th percentile, stage times",
      [](Session& session, const SuiteOptions& options) {
        const auto bases =
            options.bases.empty() ? std::vector<std::string>{"sh2", "srbf8v2"} : options.bases;
        std::vector<Group> groups;
        for (const PresetName preset : {PresetName::best, PresetName::paper}) {
          Group& cases = groups.emplace_back();
          for (const std::string& basis : bases) {
            for (const Recompute recompute : values_of<Recompute>())
              cases.push_back(frame_case(session, options, preset, basis, recompute));
          }
        }
        return groups;
      },
      frame_table};
}

}  // namespace clpv::bench
