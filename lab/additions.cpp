// SPDX-License-Identifier: MIT
#include "additions.hpp"

#include <fmt/format.h>

#include <memory>
#include <string>
#include <vector>

#include "baselines/baseline.hpp"
#include "cli/commands.hpp"
#include "cli/options.hpp"
#include "device/session.hpp"
#include "image/image_io.hpp"
#include "options/render_options.hpp"
#include "scene/scene.hpp"
#include "support/error.hpp"
#include "support/output_file.hpp"
#include "support/progress.hpp"
#include "support/text.hpp"

namespace clpv {

/// Options --baseline, --baseline-time and --images of `clpv-lab quality`. A baseline that does not
/// have a scene's light is a rejected cell.
class QualityBaselines : public QualityAddition {
 public:
  void add_options(CLI::App& command) override;
  std::string asked() const override;
  std::vector<NamedFile> outputs(const std::vector<Subject>& subjects) const override;
  std::vector<QualityCell> measure(Session& session, const std::vector<Subject>& subjects,
                                   const std::function<RenderOptions(const SceneData&)>& frame_of,
                                   int bounces, Show show, int frames) const override;

 private:
  std::vector<Baseline> names_;
  double time_ = 0;     ///< time of each [ms]; 0: the frame's
  std::string images_;  ///< folder for their images; empty: none
};

namespace {

std::filesystem::path image_file(const std::string& images, Baseline baseline,
                                 const Subject& subject, const SceneCamera& camera) {
  return std::filesystem::path(images) / name_of(baseline) /
         (view_file_name(subject.scene.name, camera.name) + ".exr");
}

}  // namespace

void QualityBaselines::add_options(CLI::App& command) {
  CLI::Option* names = add_choices(command, "--baseline", names_,
                                   "other methods to compare with, repeatable; each takes the time "
                                   "of the frame without G-buffer, shadow\n"
                                   "maps and shading");
  const NumberRange range{1e-3, 1e7, "0.001..1e7 ms"};
  add_number(command, "--baseline-time", "MS", time_,
             "time of each baseline in place of the frame's [ms]", range)
      ->needs(names);
  add(command, "--images", "DIR", images_,
      "folder for images: DIR/BASELINE/SCENE-CAMERA.exr, characters other than letters, digits, - "
      "and _ replaced")
      ->needs(names);
}

std::string QualityBaselines::asked() const {
  return names_.empty() ? "" : "--baseline";
}

std::vector<NamedFile> QualityBaselines::outputs(const std::vector<Subject>& subjects) const {
  if (images_.empty()) return {};
  require_distinct_names("--images", subjects);
  std::vector<NamedFile> files;
  for (const Baseline baseline : names_) {
    create_folder("--images", std::filesystem::path(images_) / name_of(baseline));
    for (const Subject& subject : subjects)
      for (const SceneCamera& camera : subject.cameras)
        files.push_back({"--images", image_file(images_, baseline, subject, camera), true});
  }
  return files;
}

std::vector<QualityCell> QualityBaselines::measure(
    Session& session, const std::vector<Subject>& subjects,
    const std::function<RenderOptions(const SceneData&)>& frame_of, int bounces, Show show,
    int frames) const {
  std::size_t views = 0;
  for (const Subject& subject : subjects) views += subject.cameras.size();
  Progress progress("baselines", views * names_.size());
  std::vector<QualityCell> cells;
  for (const Subject& subject : subjects) {
    const RenderOptions options = frame_of(subject.scene);
    Frame frame(session, subject.scene, options);
    for (std::size_t c = 0; c < subject.cameras.size(); ++c) {
      const SceneCamera& camera = subject.cameras[c];
      const baselines::View view(subject.scene, camera, options.width, options.height, bounces,
                                 static_cast<int>(session.device().compute_units));
      BaselineBudget budget = baseline_budget(session, frame, camera, frames);
      if (time_ > 0) budget.budget_ms = time_;
      for (const Baseline baseline : names_) {
        MeasuredBaseline measured;
        QualityCell& cell = measured.cell;
        try {
          measured = measure_baseline(baseline, view, budget, subject.truths[c], show, frames);
        } catch (const Error& error) {
          if (error.code() != ExitCode::usage) throw;
          cell.rejected = error.what();
        }
        if (!images_.empty() && cell.rejected.empty()) {
          measured.image.metadata[kViewHash] =
              view_hash(subject.scene, camera, options.width, options.height);
          write_exr(image_file(images_, baseline, subject, camera), measured.image);
        }
        cell.scene = subject.scene.name, cell.camera = camera.name;
        cell.variant = {{"baseline", std::string(name_of(baseline))}};
        cells.push_back(std::move(cell));
        progress.advance();
      }
    }
  }
  return cells;
}

Additions lab_additions() {
  return {std::make_shared<QualityBaselines>()};
}

}  // namespace clpv
