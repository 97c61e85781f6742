// SPDX-License-Identifier: MIT
// The pipeline's stages as jobs: inject, propagate, sweep, gather, each with its cost and its CPU reference.
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "bench/inputs.hpp"
#include "bench/job.hpp"
#include "options/render_options.hpp"
#include "options/stages.hpp"
#include "scene/scene.hpp"
#include "volume/volume_format.hpp"

namespace clpv::bench {

inline constexpr double kChannels = 3;  // red, green, blue

/// What the jobs of a suite share.
struct Bench {
  Session& session;
  std::function<std::shared_ptr<Inputs>()> see;  ///< makes the inputs, at their first use
  /// CPU references' results by what they depend on: variants that should agree share one. In double, Volume's host order.
  std::map<std::string, std::shared_ptr<const std::vector<double>>> references;

  Inputs& inputs() {
    if (!seen) seen = see();
    return *seen;
  }
  std::shared_ptr<Inputs> seen;

  /// The CPU reference's result under `key`, made by `make` the first time.
  template <typename Make>
  std::shared_ptr<const std::vector<double>> expected(const std::string& key, Make make) {
    auto& entry = references[key];
    if (!entry) entry = std::make_shared<const std::vector<double>>(make());
    return entry;
  }
};

/// A row for `stage` of `variant`: n, and the name STAGE/BASIS/LAYOUT/STORAGE with what else is not the default, then
/// `more` ("/grid:64").
Row make_row(const std::string& suite, std::string_view stage, const Variant& variant,
             const std::string& more = {});

/// RSM -> light volume, and with occlusion RSM and G-buffer -> geometry volume; of variant.cascade (default 0).
Job inject_job(Bench& bench, const Variant& variant);
/// Either volume alone. The geometry volume's wants occlusion.
Job inject_light_job(Bench& bench, const Variant& variant);
Job inject_geometry_job(Bench& bench, const Variant& variant);
/// Light volume -> accumulated light volume; with occlusion past the geometry volume.
Job propagate_job(Bench& bench, const Variant& variant);
/// Light volume -> light swept through its cascade from a dark border, in nine harmonics; with occlusion past what the scene's
/// triangles block there, the links' transmittance included. Wants swept().
Job sweep_job(Bench& bench, const Variant& variant);
/// The variant as the defaults would have it move light: by the sweep, past areas.
Variant swept(Variant variant);
/// Accumulated volumes of all cascades -> irradiance of every pixel. Every kCheckedPixels-th is held against the CPU reference.
Job gather_job(Bench& bench, const Variant& variant);
inline constexpr std::size_t kCheckedPixels = 61;  // a prime, so that every row and column takes its turn

/// A stage that works on volumes, or a part of it, and its job.
struct StageJob {
  Stage stage;
  Job (*make)(Bench& bench, const Variant& variant);
  Pass part = Pass::whole;

  std::string_view name() const { return part == Pass::whole ? name_of(stage) : name_of(part); }
};
inline constexpr StageJob kInject{Stage::inject, inject_job},
    kInjectLight{Stage::inject, inject_light_job, Pass::inject_light},
    kInjectGeometry{Stage::inject, inject_geometry_job, Pass::inject_geometry},
    kPropagate{Stage::propagate, propagate_job, Pass::propagate}, kSweep{Stage::sweep, sweep_job},
    kGather{Stage::gather, gather_job, Pass::gather};
inline constexpr StageJob kStageJobs[] = {kInject, kPropagate, kSweep, kGather};

/// A part of rasterising a scene as `camera` sees it (empty: its first), lit by the first light that shines there: rasterize_camera, the
/// camera's G-buffer; rasterize_shadow, that light's shadow maps; rasterize_rsm, its RSMs of all cascades. In
/// bench/rasterize_job.cpp, as the peer.
Job rasterize_job(Session& session, std::shared_ptr<const Scene> scene, const std::string& camera, Pass pass,
                  const RenderOptions& options);
/// The same by OpenGL (bench/baseline/rasterize_gl.hpp).
Job rasterize_gl_job(Session& session, std::shared_ptr<const Scene> scene, const std::string& camera,
                     Pass pass, const RenderOptions& options);

/// Light volumes of n^3 cells in Volume's host order: the largest difference, over the CPU reference's largest value.
Deviation compare_volumes(const std::vector<float>& device, const std::vector<double>& expected, int n,
                          double tolerance);

/// Of the variant; of a sweep, of swept(variant).
Case stage_case(Bench& bench, const std::string& suite, const StageJob& job, const Variant& variant,
                const std::string& more = {});

}  // namespace clpv::bench
