// SPDX-License-Identifier: MIT
// How far an image is from its reference, in figures and as the paper's difference image.
#pragma once

#include <cstdint>
#include <glm/vec2.hpp>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>

#include "image/image.hpp"

namespace clpv {

/// Errors of A against the reference B, over the colour channels: R, G and B, or else all but alpha. Alpha is
/// not compared; it tells which pixels are valid, those above 0 in both (all, where there is no alpha).
/// Without a value (null in JSON) is what has none: relative to a black reference, decibels of no error.
struct Comparison {
  int width = 0, height = 0, channels = 0;
  Encoding encoding = Encoding::linear;
  double rmse = 0;
  std::optional<double> nrmse;    ///< rmse over the root mean square of B
  double relative_mse = 0;        ///< mean of (a-b)^2 / (b^2 + .01)
  std::optional<double> psnr_db;  ///< against a peak of 1
  double max_error = 0;
  glm::ivec2 max_error_at{0};      ///< x, y from the top left corner
  glm::dvec2 mean_luminance{0};    ///< of A, of B (Rec. 709; one channel: itself)
  bool identical = false;          ///< every value of every colour channel is the same
  std::uint64_t valid_pixels = 0;  ///< the following are over these
  std::optional<double> nrmse_valid;
  std::optional<double> best_gain;  ///< g that brings g A closest to B
  std::optional<double> nrmse_best_gain;
  std::optional<double> energy_ratio;     ///< sum of A over sum of B
  std::uint64_t perceptual_failures = 0;  ///< pixels that fail OpenImageIO's test after Yee (1999)
};

/// `a_name`, `b_name`: for messages. Throws Error(bad_input) where the images cannot be compared: different
/// sizes, different numbers of colour channels, one linear and one sRGB-encoded, a value that is not finite.
Comparison compare(const Image& a, const std::string& a_name, const Image& b, const std::string& b_name);

nlohmann::json to_json(const Comparison& comparison);

/// |A - B| x amplify over the colour channels, as R,G,B; encoding as in A and B. Both fit (compare threw
/// nothing).
Image difference_image(const Image& a, const Image& b, float amplify);

}  // namespace clpv
