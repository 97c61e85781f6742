// SPDX-License-Identifier: MIT
// Subjects of a quality run: scenes, their cameras, the ground truth of each view, and the cache
// folder.
#pragma once

#include <CLI/CLI.hpp>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "cli/options.hpp"
#include "quality/ground_truth.hpp"
#include "scene/scene.hpp"

namespace clpv {

/// Command-line values.
struct QualitySubjects {
  std::vector<std::string> scenes;  ///< files
  /// "STEM=PATH", STEM of a scene file; for one scene also "PATH".
  std::vector<std::string> models;
  std::vector<std::string> cameras;  ///< names; empty: all
  SceneChanges changes;              ///< for all scenes
  double time = 0;                   ///< time of the frame [s]
};

/// Adds --model, --camera, the options of add_scene_changes() and --time.
void add_subject_options(CLI::App& command, QualitySubjects& subjects);

/// A scene, the selected cameras, and the ground truth of each view.
struct Subject {
  SceneData scene;
  std::vector<SceneCamera> cameras;
  std::vector<GroundTruth> truths;  ///< one per camera, after tracing
};

/// Returns the cache folder of quality runs: `given` (--cache), or the user's cache if that is
/// empty. Throws Error(usage) if neither exists.
std::filesystem::path quality_cache(const std::string& given);

/// Loads the scenes at that time, without ground truths. Throws the errors of load_scene, and
/// Error(usage) for a camera or model that matches no scene.
std::vector<Subject> load_subjects(const QualitySubjects& given);

/// Throws Error(usage) if two views have one view_file_name(), as scenes of one stem do. `option`:
/// of the files.
void require_distinct_names(const std::string& option, const std::vector<Subject>& subjects);

/// Sets the ground truths, from the cache in `folder` or by tracing with a progress bar.
/// `frame_of`: options of a scene's frames. Collective over all ranks.
void trace_truths(std::vector<Subject>& subjects,
                  const std::function<RenderOptions(const SceneData&)>& frame_of,
                  const pathtracer::PathTracerOptions& options, const std::filesystem::path& folder,
                  Ranks& ranks = single_rank());

}  // namespace clpv
