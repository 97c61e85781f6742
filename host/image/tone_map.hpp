// SPDX-License-Identifier: MIT
// From linear radiance to what a display shows: exposure, tone curve, sRGB encoding.
#pragma once

#include <glm/vec3.hpp>

#include "image/image.hpp"
#include "support/named_enum.hpp"

namespace clpv {

enum class ToneMap { none, reinhard, aces };

template <>
inline constexpr auto kNames<ToneMap> = name_list("none", "reinhard", "aces");

/// The tone curve on linear colour, into [0,1].
/// none: clamped. reinhard: E. Reinhard et al. 2002, eq. 3, L/(1+L) on the luminance, then clamped.
/// aces: K. Narkowicz's fit of the ACES RRT+ODT (2015), (x(2.51x+.03)) / (x(2.43x+.59)+.14), a channel at a
/// time.
glm::vec3 tone_curve(ToneMap curve, const glm::vec3& linear);

/// IEC 61966-2-1, for [0,1].
float srgb_encode(float linear);
float srgb_decode(float encoded);

/// Rec. 709 luminance.
float luminance(const glm::vec3& linear);

/// What a display shows of `image` (linear, channels R,G,B and perhaps A): colour x 2^exposure through the
/// curve and sRGB-encoded; alpha as it is, and colour 0 where alpha is 0.
Image display_image(const Image& image, float exposure, ToneMap curve);

}  // namespace clpv
