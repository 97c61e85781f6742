// SPDX-License-Identifier: MIT
// Comparison of an image with its reference: errors and difference image.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "clpv/compare.hpp"
#include "image/image.hpp"

namespace clpv {

/// Throws Error(bad_input) for different sizes, pixels that only one of the files has, different
/// numbers of colour channels or encodings, and for values that are not finite. Messages contain
/// `a_name` and `b_name`.
void check_comparable(const Image& a, const std::string& a_name, const Image& b,
                      const std::string& b_name);

/// Compares A with the reference B. Throws as check_comparable(). Linear images are tone-mapped for
/// FLIP: ToneMap::aces at `exposure` [EV].
Comparison compare(const Image& a, const std::string& a_name, const Image& b,
                   const std::string& b_name, float exposure = 0);

/// Throws Error(validation), with both names, if no pixel is valid in both.
void require_valid_pixels(const Comparison& comparison, const std::string& a_name,
                          const std::string& b_name);

nlohmann::json to_json(const Comparison& comparison);

/// FLIP of each pixel, row by row, as in compare(); 0 where a pixel is not valid. The images must
/// be ones that compare() accepts.
std::vector<double> flip_map(const Image& a, const Image& b, float exposure);

/// Difference image amplify * |A - B| over the colour channels, as R, G, B, in the encoding of A
/// and B. The images must be ones that compare() accepts.
Image difference_image(const Image& a, const Image& b, float amplify);

// FLIP: the difference that an observer sees who flips between two images.
//
// Andersson, Nilsson, Akenine-Moeller, Oskarsson, Astroem, Fairchild, 'FLIP: A Difference Evaluator
// for Alternating Images', Proceedings of the ACM on Computer Graphics and Interactive Techniques
// 3(2), 2020. Numbers are those of its section 6; images of low dynamic range.

/// A viewer's display: 3840 pixels over 0.7 m, seen from 0.7 m.
inline constexpr double kPixelsPerDegree = 67.0206;

/// FLIP of each pixel, from 0 (no visible difference) to 1, row by row. `a` and `b` have
/// sRGB-encoded channels R, G and B first, and equal sizes.
std::vector<double> flip(const Image& a, const Image& b,
                         double pixels_per_degree = kPixelsPerDegree);

}  // namespace clpv
