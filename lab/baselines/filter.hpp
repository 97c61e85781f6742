// SPDX-License-Identifier: MIT
// Joint bilateral filter of irradiance. Albedo is not part of irradiance, so textures stay sharp
// without a weight for it.
#pragma once

#include <span>
#include <vector>

#include "baselines/view.hpp"

namespace clpv::baselines {

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
