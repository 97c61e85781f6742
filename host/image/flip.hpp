// SPDX-License-Identifier: MIT
// FLIP: the difference that an observer sees who flips between two images.
//
// Andersson, Nilsson, Akenine-Moeller, Oskarsson, Astroem, Fairchild, 'FLIP: A Difference Evaluator
// for Alternating Images', Proceedings of the ACM on Computer Graphics and Interactive Techniques
// 3(2), 2020. Numbers are those of its section 6; images of low dynamic range.
#pragma once

#include <vector>

#include "image/image.hpp"

namespace clpv {

/// A viewer's display: 3840 pixels over 0.7 m, seen from 0.7 m.
inline constexpr double kPixelsPerDegree = 67.0206;

/// FLIP of each pixel, from 0 (no visible difference) to 1, row by row. `a` and `b` have
/// sRGB-encoded channels R, G and B first, and equal sizes.
std::vector<double> flip(const Image& a, const Image& b,
                         double pixels_per_degree = kPixelsPerDegree);

}  // namespace clpv
