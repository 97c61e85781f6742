// SPDX-License-Identifier: MIT
// What a quality run looks at: scenes, their cameras, the truth of each view, and where truths are kept.
#pragma once

#include <CLI/CLI.hpp>
#include <filesystem>
#include <string>
#include <vector>

#include "quality/cached_reference.hpp"
#include "scene/scene.hpp"

namespace clpv {

/// As given on the command line.
struct QualitySubjects {
  std::vector<std::string> scenes;   ///< files
  std::vector<std::string> models;   ///< "STEM=PATH", STEM that of a scene's file; one scene: "PATH" does
  std::vector<std::string> cameras;  ///< names; none: all there are
  double time = 0;                   ///< the instant shown [s]
};

/// --model, --camera and --time.
void add_subject_options(CLI::App& command, QualitySubjects& subjects);

/// A scene, the cameras chosen, and the truth of what each of them sees.
struct Subject {
  Scene scene;
  std::vector<Camera> cameras;
  std::vector<reference::Reference> truths;  ///< one a camera, once traced
};

/// The folder of what quality runs keep: `given` (--cache), or where that is empty the user's cache. Throws Error(usage)
/// where there is neither.
std::filesystem::path quality_cache(const std::string& given);

/// Loads the scenes as they are at that instant, without truths. Throws like load_scene, and Error(usage) for a
/// camera that no scene has or a model that belongs to none.
std::vector<Subject> load_subjects(const QualitySubjects& given);

/// Fills in the truths, from `folder` where they are kept, with a progress bar where they must be traced. By all ranks.
void trace_truths(Subject& subject, int width, int height, const reference::PathTracerOptions& options,
                  const std::filesystem::path& folder, Ranks& ranks = single_rank());

}  // namespace clpv
