// SPDX-License-Identifier: MIT
#include "additions.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/glm.hpp>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "baselines/baseline.hpp"
#include "cli/commands.hpp"
#include "cli/options.hpp"
#include "cli/render_request.hpp"
#include "device/session.hpp"
#include "image/image_io.hpp"
#include "options/render_options.hpp"
#include "pipeline/frame/cascade.hpp"
#include "pipeline/raster/rasterize.hpp"
#include "pipeline/raster/scene_buffers.hpp"
#include "pipeline/raster/surface.hpp"
#include "pipeline/raster/view.hpp"
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
  return {std::make_shared<QualityBaselines>(), add_normals};
}

// Surface normals of a scene's reflective shadow maps, weighted by reflected flux.

/// A direction and its weight.
struct WeightedDirection {
  glm::dvec3 direction;  ///< unit
  double weight;         ///< above 0
};

namespace {

constexpr int kSide = 4;  // patches per edge of a cube face: a search uses at most 96 directions

/// Returns the patch index of direction `n` on a cube about the origin.
std::size_t patch_of(const glm::dvec3& n) {
  int axis = 0;
  for (int other = 1; other < 3; ++other) {
    if (std::abs(n[other]) > std::abs(n[axis])) axis = other;
  }
  const auto place = [&](double value) {
    return std::clamp(static_cast<int>((value / std::abs(n[axis]) + 1) / 2 * kSide), 0, kSide - 1);
  };
  const int face = 2 * axis + (n[axis] < 0 ? 1 : 0);
  return static_cast<std::size_t>((face * kSide + place(n[(axis + 1) % 3])) * kSide +
                                  place(n[(axis + 2) % 3]));
}

/// Sums of flux and of flux times normal per patch.
class Patches {
 public:
  void add(const SurfaceImage& rsm) {
    for (std::size_t i = 0; i < rsm.depth.size(); ++i) {
      const glm::dvec3 n(rsm.normal[i]), colour(rsm.colour[i]);
      const double flux = colour.x + colour.y + colour.z, length = glm::length(n);
      if (!(rsm.depth[i] > 0 && flux > 0 && length > 0)) continue;
      Patch& patch = patches_[patch_of(n / length)];
      patch.flux += flux;
      patch.normal += flux * n / length;
    }
  }
  std::vector<WeightedDirection> weights() const {
    double total = 0;
    for (const Patch& patch : patches_) total += patch.flux;
    std::vector<WeightedDirection> weights;
    for (const Patch& patch : patches_) {
      if (patch.flux > 0) weights.push_back({glm::normalize(patch.normal), patch.flux / total});
    }
    return weights;
  }

 private:
  struct Patch {
    double flux = 0;
    glm::dvec3 normal{0};
  };
  std::array<Patch, 6 * kSide * kSide> patches_{};
};

/// Groups the normals of all texels that injection reads for this camera, in all cascades, by
/// patches of the sphere. Returns each patch's mean normal, weighted by its share of the flux.
/// Empty if no surface is lit.
std::vector<WeightedDirection> normal_weights(Session& session, const SceneData& scene,
                                              const SceneCamera& camera,
                                              const RenderOptions& options) {
  const SceneBuffers buffers = upload_scene(session, scene);
  Rasterizer rasterizer(session, buffers);
  Patches patches;
  const std::vector<ClpvGrid> grids =
      cascade_grids(camera.eye, options.cascades, options.cascade_size, options.grid);
  for (const SceneLight& light : scene.lights_for(camera)) {
    // All cascades share the maps of a light that is not a sun.
    const std::size_t cascades = light.data.kind == CLPV_LIGHT_DIRECTIONAL ? grids.size() : 1;
    for (std::size_t cascade = 0; cascade < cascades; ++cascade) {
      for (const ClpvView& view :
           rsm_views(light.data, grids[cascade], buffers.bounds, options.rsm_size)) {
        Surface rsm = make_surface(session, view, RsmFormat::float32, false);
        rasterizer.rasterize_rsm(light.data, rsm);
        patches.add(read_surface(session, rsm));
      }
    }
  }
  return patches.weights();
}

/// Returns {"weights": [[x, y, z, weight], ...]}, the input of clpv_lab.search.
std::string to_json(const std::vector<WeightedDirection>& weights) {
  nlohmann::json list = nlohmann::json::array();
  for (const auto& [n, weight] : weights) list.push_back({n.x, n.y, n.z, weight});
  return nlohmann::json{{"weights", list}}.dump(1) + "\n";
}

}  // namespace

namespace normals_command {

struct Options {
  RenderRequest request;
  std::string output;
  double time = 0;
};

void run(const Options& options, const Shared& shared) {
  const std::vector<NamedFile> outputs{{"--output", options.output}};
  check_outputs(outputs);
  MovingScene moving = options.request.open();
  moving.pose(options.time);
  const SceneData& scene = moving.scene();
  const FrameSetup setup = setup_of(options.request, scene);
  check_outputs(outputs);  // now that the inputs are known
  const Device device = choose_device(shared.device);
  Session session(device, ProgramCache::of_user(device));
  write_file(
      options.output,
      to_json(normal_weights(session, scene, scene.camera(options.request.camera), setup.options)));
  session.programs().store();
}

}  // namespace normals_command

void add_normals(CLI::App& app, Shared& shared) {
  using namespace normals_command;
  CLI::App* command =
      app.add_subcommand("normals", "Lit surface normals, weighted by reflected flux");
  auto options = std::make_shared<normals_command::Options>();
  add_render_request(*command, options->request);
  add(*command, "-o,--output", "FILE.json", options->output, "output file, for clpv_lab.search")
      ->required();
  add_seconds(*command, "--time", options->time, "time in the scene's animation [s]");
  command->callback([options, &shared] { run(*options, shared); });
}

}  // namespace clpv
