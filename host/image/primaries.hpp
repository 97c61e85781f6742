// SPDX-License-Identifier: MIT
// Conversion of linear RGB between primaries.
#pragma once

#include <array>
#include <glm/mat3x3.hpp>
#include <optional>
#include <string>

namespace clpv {

/// CIE x and y of red, green, blue and white.
using Chromaticities = std::array<double, 8>;

/// Rec. 709 (ITU-R BT.709-6, table 1), whose primaries sRGB shares.
inline constexpr Chromaticities kRec709 = {0.64, 0.33, 0.3, 0.6, 0.15, 0.06, 0.3127, 0.3290};

/// True within the digits to which standards state chromaticities.
bool is_rec709(const Chromaticities& chromaticities);

/// Matrix from linear RGB of these primaries to Rec. 709. Bradford's transform adapts the white, so
/// grey stays grey (as OpenEXR's reader of ACES files does). Empty if they span no colours.
std::optional<glm::dmat3> to_rec709(const Chromaticities& chromaticities);

/// "0.64,0.33 0.3,0.6 0.15,0.06, white 0.3127,0.329"
std::string text_of(const Chromaticities& chromaticities);

}  // namespace clpv
