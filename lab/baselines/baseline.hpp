// SPDX-License-Identifier: MIT
// Baselines: other GI methods, given the time of the frame's indirect light; short runs calibrate
// them.
#pragma once

#include <map>
#include <span>
#include <string>
#include <vector>

#include "baselines/view.hpp"
#include "image/image.hpp"
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
  double rsm_ms = 0;     ///< RSMs of a cascade, on average
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

namespace clpv::baselines {

// Joint bilateral filter of irradiance. Albedo is not part of irradiance, so textures stay sharp
// without a weight for it.

/// A neighbour at this offset [pixels] and its weight.
struct Tap {
  int x, y;
  float weight;
};

/// 4 x 4 neighbours of equal weight: one pixel of each interleaved set.
std::vector<Tap> block_taps();
/// 3 x 3 neighbours at a distance of `step`, with the weights of a B-spline.
std::vector<Tap> wavelet_taps(int step);

/// Mean over the taps around each pixel. A tap counts less the more its normal differs, and the
/// farther it is from the pixel's plane, relative to its distance in the image. Pixels that were
/// not computed do not count, but receive a mean.
Irradiance joint_bilateral(const View& view, const Irradiance& image, std::span<const Tap> taps);

/// The filter with wavelet_taps() at steps 1, 2, 4, ..., `passes` times: Dammertz et al.,
/// 'Edge-Avoiding A-Trous Wavelet Transform for fast Global Illumination Filtering', HPG 2010.
Irradiance wavelet_filter(const View& view, const Irradiance& image, int passes);

/// Image of all pixels of `full` from one of `thin`, its thinned view: bilinear interpolation with
/// the weights of the joint bilateral filter, or the nearest pixel where no similar surface is
/// near.
Irradiance upsampled(const View& full, const View& thin, const Irradiance& image);

}  // namespace clpv::baselines
