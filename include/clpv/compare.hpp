// SPDX-License-Identifier: MIT
// Errors of an image against a ground truth.
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "clpv/image.hpp"

namespace clpv {

/// Errors of image A against the reference B, over the colour channels: R, G and B, or else all
/// channels but alpha. Pixels with alpha above 0 in both images are valid; without alpha all are.
/// Empty values (null in JSON) are undefined: errors relative to a black reference, decibels
/// without error.
struct Comparison {
  int width = 0, height = 0, channels = 0;
  Encoding encoding = Encoding::linear;
  double rmse = 0;
  std::optional<double> nrmse;    ///< rmse over the root mean square of B
  double relative_mse = 0;        ///< mean of (a - b)^2 / (b^2 + 0.01)
  std::optional<double> psnr_db;  ///< peak signal-to-noise ratio with peak 1 [dB]
  double max_error = 0;
  std::array<int, 2> max_error_at{};       ///< x, y from the top left corner
  std::array<double, 2> mean_luminance{};  ///< A's and B's (Rec. 709; with one channel, its mean)
  bool identical = false;                  ///< all colour channels have equal values
  std::uint64_t valid_pixels = 0;  ///< number of valid pixels, over which the following values are
  std::optional<double> nrmse_valid;
  std::optional<double> best_gain;        ///< factor g that minimises |g A - B|
  std::optional<double> nrmse_best_gain;  ///< nrmse of g A
  std::optional<double> energy_ratio;     ///< sum of A over sum of B
  std::optional<double> flip;  ///< mean FLIP, what an observer sees, 0 to 1 (Andersson et al.
                               ///< 2020); empty without valid pixels
};

/// Compares A with the reference B, over the pixels that their files have. Throws Error(bad_input)
/// for different sizes, pixels that only one has, different numbers of colour channels or
/// encodings, for fields of an image that disagree, and for values that are not finite. Linear
/// images are tone-mapped at `exposure` [EV] for FLIP. Thread-safe.
Comparison compare(const Image& a, const Image& b, float exposure = 0);

}  // namespace clpv
