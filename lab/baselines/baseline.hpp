// SPDX-License-Identifier: MIT
// Baselines: other GI methods, given the time of the frame's indirect light; short runs calibrate
// them.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "baselines/view.hpp"
#include "image/image.hpp"
#include "image/surface_image.hpp"
#include "kernels/shared/grid.h"
#include "pipeline/frame/frame.hpp"
#include "quality/quality.hpp"
#include "support/named_enum.hpp"

namespace clpv {

enum class Baseline {
  paths,              ///< path tracing
  paths_filtered,     ///< the same with a joint bilateral filter
  vpl,                ///< virtual point lights, the same for all pixels
  vpl_interleaved,    ///< different ones in each pixel of a 4 x 4 block, with a joint bilateral
                      ///< filter
  ddgi_first,         ///< irradiance probes, first frame
  ddgi_converged,     ///< the same after kConvergedFrames frames; the time is that of one
  radiance_cascades,  ///< radiance cascades
  radiance_cascades_fine,  ///< eight probes in each cell, 192 directions; takes its own time
};

template <>
inline constexpr auto kNames<Baseline> = name_list("paths", "paths-filtered", "vpl",
                                                   "vpl-interleaved", "ddgi-first",
                                                   "ddgi-converged", "radiance-cascades",
                                                   "radiance-cascades-fine");

inline constexpr unsigned kConvergedFrames = 128;

/// Time budget of baselines, and the inputs that they take from the measured frame.
struct BaselineBudget {
  double budget_ms = 0;  ///< the frame without `shared`
  double rsm_ms = 0;     ///< RSMs of the coarsest cascade
  /// Stages that every method needs: G-buffer, shadow maps, shading.
  std::vector<TimeRecord> shared;
  std::vector<SurfaceImage> rsms;  ///< RSMs of the coarsest cascade, flux in W
  std::vector<ClpvGrid> grids;     ///< grids of the cascades, finest first
};

/// Measures the budget as the median over `frames` frames that recompute all lighting.
BaselineBudget baseline_budget(Session& session, Frame& frame, const SceneCamera& camera,
                               int frames);

/// Throws Error(usage) with the reason if the method does not have the scene's light, that many
/// bounces, or the view.
void require_baseline(Baseline baseline, const SceneData& scene, int bounces, Show show);

/// Errors and times of a baseline, and its image of the view.
struct MeasuredBaseline {
  QualityCell cell;
  Image image;
};

/// Chooses the number of samples so that the method takes the budget, unless it is
/// radiance_cascades_fine. Runs it `runs` times, and compares it with the ground truth. The cell's
/// settings are samples, threads and budget; its stage `baseline` is the median time. Throws as
/// require_baseline().
MeasuredBaseline measure_baseline(Baseline baseline, const baselines::View& view,
                                  const BaselineBudget& budget, const GroundTruth& truth, Show show,
                                  int runs);

/// The method's irradiance of all pixels of `full` with this number of samples in each pixel of
/// `thin`, its thinned view. `frames`: of irradiance probes. Sets counts of what it used in
/// `settings`.
baselines::Irradiance run_baseline(Baseline baseline, const baselines::View& full,
                                   const baselines::View& thin, const BaselineBudget& budget,
                                   unsigned samples, unsigned frames,
                                   std::map<std::string, double>& settings);

}  // namespace clpv
