// SPDX-License-Identifier: MIT
#include "cli/quality_subjects.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "cli/options.hpp"
#include "scene/load.hpp"
#include "support/error.hpp"
#include "support/input_file.hpp"
#include "support/log.hpp"
#include "support/text.hpp"

namespace clpv {
namespace {

/// Returns the path in "STEM=PATH" if STEM is the stem of the scene file, else nothing.
std::string path_in(const std::string& model, const std::string& scene) {
  const std::string stem = std::filesystem::path(scene).stem().string() + "=";
  return model.starts_with(stem) ? model.substr(stem.size()) : "";
}

std::filesystem::path model_for(const std::string& scene, const QualitySubjects& given) {
  for (const std::string& model : given.models) {
    if (const std::string path = path_in(model, scene); !path.empty()) return path;
    if (given.scenes.size() == 1) return model;
  }
  return {};
}

}  // namespace

void add_subject_options(CLI::App& command, QualitySubjects& subjects) {
  add(command, "--model", "[STEM=]PATH", subjects.models,
      "model file instead of the scene file's; for several scenes: STEM=PATH, repeatable");
  CLI::Option* camera = add(command, "--camera", "NAME", subjects.cameras,
                            "name of a camera, repeatable (default: all cameras of all scenes)");
  add_scene_changes(command, subjects.changes, *camera);
  add_seconds(command, "--time", subjects.time, "time in the scene's animation [s]");
}

std::filesystem::path quality_cache(const std::string& given) {
  if (!given.empty()) return given;
  if (const auto folder = user_cache_folder()) return *folder / "quality";
  throw Error(ExitCode::usage,
              "--cache: needed where neither XDG_CACHE_HOME nor HOME is an absolute path");
}

std::vector<Subject> load_subjects(const QualitySubjects& given) {
  for (const std::string& model : given.models) {
    const auto meant = [&](const std::string& scene) { return !path_in(model, scene).empty(); };
    if (given.scenes.size() == 1 || std::ranges::any_of(given.scenes, meant)) continue;
    throw Error(ExitCode::usage,
                "--model {}: allowed with several scenes: STEM=PATH, STEM that of a scene's file",
                model);
  }
  std::vector<Subject> subjects;
  for (const std::string& path : given.scenes) {
    Subject& subject = subjects.emplace_back();
    MovingScene moving(path, model_for(path, given));
    given.changes.apply(moving);
    moving.pose(given.time);
    subject.scene = std::move(moving).take();
    for (const std::string& note : subject.scene.notes) log_info("{}", note);
    for (const SceneCamera& camera : subject.scene.cameras) {
      const bool chosen =
          given.cameras.empty() || std::ranges::count(given.cameras, camera.name) > 0;
      if (chosen) subject.cameras.push_back(camera);
    }
  }
  for (const std::string& name : given.cameras) {
    const auto has = [&](const Subject& s) {
      return std::ranges::count(s.cameras, name, &SceneCamera::name) > 0;
    };
    if (std::ranges::none_of(subjects, has))
      subjects[0].scene.camera(name);  // throws an error that lists the camera names
  }
  return subjects;
}

void require_distinct_names(const std::string& option, const std::vector<Subject>& subjects) {
  std::map<std::string, std::string> views;  // by file name
  for (const Subject& subject : subjects) {
    for (const SceneCamera& camera : subject.cameras) {
      const std::string view = fmt::format("{}, camera '{}'", subject.scene.path, camera.name);
      const auto [other, first] =
          views.try_emplace(view_file_name(subject.scene.name, camera.name), view);
      if (first) continue;
      throw Error(
          ExitCode::usage,
          "{}: {}.exr would be the file of {} and of {}; allowed: scenes of different names",
          option, other->first, other->second, view);
    }
  }
}

void trace_truths(std::vector<Subject>& subjects,
                  const std::function<RenderOptions(const SceneData&)>& frame_of,
                  const pathtracer::PathTracerOptions& options, const std::filesystem::path& folder,
                  Ranks& ranks) {
  std::size_t views = 0;
  for (const Subject& subject : subjects) views += subject.cameras.size();
  Progress progress("ground truths", views * kTraceSteps);
  std::uint64_t traced = 0;
  for (Subject& subject : subjects) {
    const RenderOptions frame = frame_of(subject.scene);
    for (const SceneCamera& camera : subject.cameras) {
      subject.truths.push_back(cached_ground_truth(folder, subject.scene, camera, frame.width,
                                                   frame.height, options,
                                                   trace_progress(progress, traced), ranks));
      const GroundTruth& truth = subject.truths.back();
      truth.traced ? void(traced += kTraceSteps) : progress.skip(kTraceSteps);
      log_debug("{}: {} paths per pixel, noise {:.4f}", truth.file.string(), truth.samples,
                truth.noise);
    }
  }
}

}  // namespace clpv
