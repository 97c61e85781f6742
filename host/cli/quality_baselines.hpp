// SPDX-License-Identifier: MIT
// Baselines of a quality run: other GI methods, given the time of the frame's indirect light.
#pragma once

#include <CLI/CLI.hpp>
#include <functional>
#include <string>
#include <vector>

#include "cli/quality_subjects.hpp"
#include "device/session.hpp"
#include "quality/baseline.hpp"
#include "support/output_file.hpp"

namespace clpv {

/// Command-line values.
struct QualityBaselines {
  std::vector<Baseline> names;
  double time = 0;     ///< of each [ms]; 0: the frame's
  std::string images;  ///< folder for their images; empty: none
};

/// Adds --baseline, --baseline-time and --images.
void add_baseline_options(CLI::App& command, QualityBaselines& baselines);

/// Returns the files of --images, if given, and creates their folders. Throws Error(usage) if two
/// views have one name.
std::vector<NamedFile> image_files(const QualityBaselines& baselines,
                                   const std::vector<Subject>& subjects);

/// Measures each baseline in each view of the subjects, which have their ground truths.
/// `options_of`: of the frame whose time they get. A baseline that does not have a scene's light is
/// a rejected cell.
std::vector<QualityCell> measure_baselines(
    const QualityBaselines& baselines, Session& session, const std::vector<Subject>& subjects,
    const std::function<RenderOptions(const SceneData&)>& options_of, int bounces, Show show,
    int frames);

}  // namespace clpv
