// SPDX-License-Identifier: MIT
// Jobs for the pipeline's stages inject, propagate, sweep and gather, each with its cost
// and its CPU reference.
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "bench/row.hpp"
#include "device/session.hpp"
#include "options/render_options.hpp"
#include "options/stages.hpp"
#include "pipeline/raster/scene_buffers.hpp"
#include "scene/scene.hpp"
#include "verify/jobs.hpp"
#include "volume/volume.hpp"
#include "volume/volume_format.hpp"

namespace clpv::bench {

// Inputs of the benchmarked stages: RSMs and G-buffer of a scene, and the volumes injected from
// them.

/// RSMs and G-buffer of one scene, rasterised on the device once. Texels within rounding of a cell
/// boundary (about 0.1 %) are emptied, so that a stage and its CPU reference assign every texel to
/// the same cell.
class Inputs {
 public:
  /// Rasterises `scene` from `camera` and from the first light that applies there. `options` gives
  /// sizes and cascades. Throws Error(bad_input) if no light applies.
  Inputs(Session& session, const SceneData& scene, const SceneCamera& camera,
         const RenderOptions& options);

  /// Surfaces of one cascade.
  struct CascadeViews {
    ClpvGrid grid{};
    verify::InjectedSurface rsm, camera;  ///< the RSM in the options' format
  };
  const CascadeViews& views(int cascade) const { return views_.at(cascade); }
  std::vector<ClpvGrid> grids() const;

  /// Injected light volume and geometry volume of a cascade in a basis, blocking one-sided as
  /// published. Computed at the first call.
  verify::SharedVolume light(const Basis& basis, int cascade) {
    return injected(basis, cascade).light;
  }
  verify::SharedVolume geometry(const Basis& basis, int cascade) {
    return injected(basis, cascade).geometry;
  }
  /// Areas blocked by the scene's triangles in a cascade, at cell corners, as the sweep by default
  /// takes them. Computed at the first call.
  verify::SharedVolume areas(int cascade);

 private:
  struct InjectedVolumes {
    verify::SharedVolume light, geometry;
  };
  const InjectedVolumes& injected(const Basis& basis, int cascade);
  verify::SharedVolume to_host(const Volume& volume);

  Session& session_;
  RenderOptions options_;
  SceneBuffers scene_;
  std::vector<CascadeViews> views_;
  std::map<std::pair<std::string, int>, InjectedVolumes> injected_;
  std::map<int, verify::SharedVolume> areas_;
};

/// Inputs and CPU references shared by the jobs of a suite.
struct Bench {
  Session& session;
  std::function<std::shared_ptr<Inputs>()> make_inputs;  ///< called at the first use of inputs()
  /// Results of the CPU reference, by a key over what they depend on. Problems that should agree
  /// share one.
  std::map<std::string, verify::Values> references;

  Inputs& inputs() {
    if (!made_inputs) made_inputs = make_inputs();
    return *made_inputs;
  }
  std::shared_ptr<Inputs> made_inputs;

  /// Shares the result of the CPU reference under `key`.
  verify::Share share(const std::string& key) {
    return [this, key](const std::function<std::vector<double>()>& compute) {
      verify::Values& entry = references[key];
      if (!entry) entry = verify::not_shared(compute);
      return entry;
    };
  }
};

/// Makes a row for `stage` of `problem`. Its name is STAGE/BASIS/LAYOUT/STORAGE, then all settings
/// that differ from timed_options(), then `suffix` ("/grid:64").
Row make_row(const std::string& suite, std::string_view stage, const Problem& problem,
             const std::string& suffix = {});

/// RSM -> light volume and, with occlusion, RSM and G-buffer -> geometry volume. Cascade
/// problem.cascade, default 0.
Job inject_job(Bench& bench, const Problem& problem);
/// RSM -> light volume only.
Job inject_light_job(Bench& bench, const Problem& problem);
/// RSM and G-buffer -> geometry volume only. Needs occlusion.
Job inject_geometry_job(Bench& bench, const Problem& problem);
/// Light volume -> accumulated light volume; occlusion by the geometry volume.
Job propagate_job(Bench& bench, const Problem& problem);
/// Light volume -> swept light of one cascade in nine harmonics, with a dark border. Occlusion by
/// the scene's triangles; the time includes the links' transmittance. Needs a problem of
/// with_sweep().
Job sweep_job(Bench& bench, const Problem& problem);
/// The problem with the default transport: the sweep, with blockers as areas.
Problem with_sweep(Problem problem);
/// Accumulated volumes of all cascades -> irradiance of every pixel. Verifies every
/// kCheckedPixels-th pixel.
Job gather_job(Bench& bench, const Problem& problem);
// A prime, so that checked pixels lie in all rows and columns.
inline constexpr std::size_t kCheckedPixels = 61;

/// A stage that works on volumes, or one pass of it, and its job.
struct StageJob {
  Stage stage;
  Job (*make)(Bench& bench, const Problem& problem);
  Pass pass = Pass::whole;

  std::string_view name() const { return pass == Pass::whole ? name_of(stage) : name_of(pass); }
};
inline constexpr StageJob kInject{Stage::inject, inject_job},
    kInjectLight{Stage::inject, inject_light_job, Pass::inject_light},
    kInjectGeometry{Stage::inject, inject_geometry_job, Pass::inject_geometry},
    kPropagate{Stage::propagate, propagate_job, Pass::propagate}, kSweep{Stage::sweep, sweep_job},
    kGather{Stage::gather, gather_job, Pass::gather};

/// A case of `job` with `problem`, or with with_sweep(problem) for the sweep.
Case stage_case(const std::shared_ptr<Bench>& bench, const std::string& suite, const StageJob& job,
                const Problem& problem);

}  // namespace clpv::bench
