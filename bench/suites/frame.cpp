// SPDX-License-Identifier: MIT
// Suite `frame`: whole frames along a camera path, of light made anew or kept, and what each stage of them takes.
#include "pipeline/frame.hpp"

#include <fmt/format.h>

#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <map>

#include "bench/suites.hpp"
#include "options/render_options.hpp"
#include "support/named_enum.hpp"
#include "verify/comparison.hpp"

namespace clpv {
namespace bench {

/// What of a frame each repetition makes anew, besides what the camera sees.
enum class Anew {
  light,       ///< as if the lights had changed; what blocks and hides where cascades moved
  everything,  ///< from nothing
  nothing,     ///< what a camera costs that looks round among things and lights at rest
};

}  // namespace bench

template <>
inline constexpr auto kNames<bench::Anew> = name_list("light", "everything", "nothing");

}  // namespace clpv

namespace clpv::bench {
namespace {

constexpr int kPathFrames = 24;
constexpr double kTurn = 0.6, kSway = 0.5;  // [rad], [m]: to either side, once along the path

/// A camera that looks round to either side and sways, back where it began after kPathFrames.
Camera on_path(Camera camera, int frame, double sway) {
  const double phase = 2 * 3.14159265358979 * frame / kPathFrames;
  const glm::mat4 turn =
      glm::rotate(glm::mat4(1.0f), static_cast<float>(kTurn * std::sin(phase)), glm::vec3(0, 1, 0));
  camera.forward = glm::vec3(turn * glm::vec4(camera.forward, 0));
  camera.up = glm::vec3(turn * glm::vec4(camera.up, 0));
  const glm::vec3 right = glm::cross(camera.forward, camera.up);
  camera.eye += right * static_cast<float>(sway * std::sin(phase));
  return camera;
}

/// A frame in use, and the stages' times of every one rendered.
struct Path {
  std::shared_ptr<const Scene> scene;
  Camera start;
  Anew anew;
  Frame frame;
  int next = 0;
  bool warm = false;
  std::map<std::string, std::vector<double>> stage_ms;

  Path(Session& session, std::shared_ptr<const Scene> lit, const std::string& camera,
       const RenderOptions& options, Anew made_anew)
      : scene(std::move(lit)),
        start(scene->camera(camera)),
        anew(made_anew),
        frame(session, *scene, options) {}

  /// Cascades stay where they are if nothing is to be made anew.
  Camera at(int number) const { return on_path(start, number, anew == Anew::nothing ? 0 : kSway); }

  void invalidate() {
    switch (anew) {
      case Anew::light:
        return frame.forget_light();
      case Anew::everything:
        return frame.invalidate();
      case Anew::nothing:
        return;
    }
  }

  void add(const std::vector<StageTime>& times) {
    std::map<std::string, double> sums;  // over cascades and lights
    for (const StageTime& time : times) sums[std::string(name_of(time.mark.pass))] += time.ms;
    if (warm) {  // the first run compiles
      for (const auto& [stage, ms] : sums) stage_ms[stage].push_back(ms);
    }
    warm = true;
  }
};

std::vector<Row> stage_rows(const Path& path, const Row& frame) {
  std::vector<Row> rows;
  for (auto [stage, ms] : path.stage_ms) {
    ms.resize(frame.samples_ms.size(), 0.0);  // a frame that did without took none
    Row row = frame;
    row.stage = stage;
    row.name = stage + frame.name.substr(frame.name.find('/'));
    row.samples_ms = ms;
    row.times = statistics_of(ms);
    row.wall_ms = row.cpu_ms = row.first_launch_ms = row.build_ms = 0;
    row.from_events = true;
    row.max_rel_error.reset();  // the frame's is of the whole image
    row.cost = {};
    row.ceiling.clear();
    row.ceiling_share = 0;
    rows.push_back(std::move(row));
  }
  return rows;
}

/// The last frame again, from nothing: the same bytes, whatever was rendered before it.
Deviation repeat(Path& path, Session& session) {
  const std::vector<float> timed = path.frame.read(Show::full);
  path.frame.render(path.at(path.next + kPathFrames / 2));
  path.frame.invalidate();
  path.frame.render(path.at(path.next - 1));
  session.queue().finish();
  const std::vector<float> again = path.frame.read(Show::full);
  const reference::WorstError worst = reference::worst_difference(
      again.size(), [&](std::size_t i) { return double{timed[i]}; },
      [&](std::size_t i) { return double{again[i]}; });
  if (worst.value == 0) return {0, 0, {}};
  return {worst.value, 0,
          fmt::format("pixel {} channel {}: {:.7g}, rendered again {:.7g}", worst.at / 4, worst.at % 4,
                      timed[worst.at], again[worst.at])};
}

Job frame_job(Session& session, const SuiteOptions& options, const RenderOptions& render, Anew anew) {
  const auto path = std::make_shared<Path>(session, scene_of(options), options.camera, render, anew);
  Job job;
  job.own_stages = true;
  job.reset = [path] { path->invalidate(); };
  job.run = [path] { path->frame.render(path->at(path->next++)); };
  job.after_run = [path](const std::vector<StageTime>& times) { path->add(times); };
  job.more_rows = [path](const Row& row) { return stage_rows(*path, row); };
  job.verify = [path, &session] { return repeat(*path, session); };
  return job;
}

Case frame_case(Session& session, const SuiteOptions& options, PresetName preset, const std::string& basis,
                Anew anew) {
  RenderOptions render;
  apply_preset(render, preset);
  render.basis = basis;
  render.cascades = options.settings.cascades, render.cascade_size = options.settings.cascade_size;
  Variant variant;
  variant.options = render;
  variant.options.lobe = LobeKind::exact;  // the preset's name tells which they are
  variant.options.lobe_time = LobeTime::host;
  Case result;
  result.row =
      make_row("frame", "frame", variant, fmt::format("/{}/anew:{}", name_of(preset), name_of(anew)));
  result.row.preset = name_of(preset);
  result.row.anew = name_of(anew);
  result.make = [&session, options, render, anew] { return frame_job(session, options, render, anew); };
  return result;
}

std::string frame_table(const std::vector<Row>& rows) {
  std::string text =
      fmt::format("{:<62} {:>10} {:>9} {:>9} {:>9} {:>7}\n", "row", "median ms", "p95", "max", "mad", "fps");
  for (const Row& row : rows) {
    text += fmt::format("{:<62} {:>10.2f} {:>9.2f} {:>9.2f} {:>9.2f} {:>7}{}\n", row.name, row.times.median,
                        row.times.p95, row.times.max, row.times.mad,
                        row.stage == "frame" ? fmt::format("{:.1f}", 1e3 / row.times.median) : "",
                        row.status == Status::wrong ? "  WRONG" : "");
  }
  return text;
}

}  // namespace

Suite frame_suite() {
  return {
      "frame", "whole frames along a camera path: frames a second, median, 95th percentile, each stage",
      [](Session& session, const SuiteOptions& options) {
        const auto bases = options.bases.empty() ? std::vector<std::string>{"sh2", "srbf8v2"} : options.bases;
        std::vector<Group> groups;
        for (const PresetName preset : values_of<PresetName>()) {
          groups.push_back({[&session, options, bases, preset] {
            std::vector<Case> cases;
            for (const std::string& basis : bases) {
              for (const Anew anew : values_of<Anew>())
                cases.push_back(frame_case(session, options, preset, basis, anew));
            }
            return cases;
          }});
        }
        return groups;
      },
      frame_table};
}

}  // namespace clpv::bench
