// SPDX-License-Identifier: MIT
// Linear radiance to display values: exposure, tone curve, sRGB encoding.
#pragma once

#include <glm/vec3.hpp>

#include "image/image.hpp"
#include "support/named_enum.hpp"

namespace clpv {

enum class ToneMap { none, reinhard, aces, photographic };

template <>
inline constexpr auto kNames<ToneMap> = name_list("none", "reinhard", "aces", "photographic");

/// Curve of PNG files unless another is given: dark colours keep their ratios.
inline constexpr ToneMap kDisplayCurve = ToneMap::photographic;

/// Applies a tone curve to a linear colour; the result is clamped to [0, 1]. none: identity.
/// reinhard: L / (1 + L) on the luminance (Reinhard et al. 2002, eq. 3). aces: fit of the ACES RRT
/// and ODT per channel, (x (2.51 x + 0.03)) / (x (2.43 x + 0.59) + 0.14) (Narkowicz 2015).
/// photographic: x (1 + x / 36) / (1 + x) per channel, 1 at x = 6 (Reinhard et al. 2002, eq. 4).
glm::vec3 tone_curve(ToneMap curve, const glm::vec3& linear);

/// sRGB transfer function (IEC 61966-2-1) and its inverse, for values in [0, 1].
float srgb_encode(float linear);
float srgb_decode(float encoded);

/// Rec. 709 luminance.
float luminance(const glm::vec3& linear);

/// Background of a display image: black, without channel A, or transparent where there is an A.
enum class Background { black, transparent };

/// Throws Error(bad_input), which begins with `name`, for sRGB-encoded values.
void require_linear(const char* name, const Image& image);
/// Throws Error(usage) for an exposure [EV] that is not finite.
void check_exposure(float exposure);

/// Display image of a linear image with R, G, B and optionally A: tone_curve(2^exposure * colour),
/// sRGB-encoded. Alpha is clamped to [0, 1]; colour is 0 where alpha is 0.
/// Throws Error: bad_input (other channels, sRGB-encoded values), usage (check_exposure).
Image display_image(const Image& image, float exposure, ToneMap curve,
                    Background background = Background::black);

}  // namespace clpv
