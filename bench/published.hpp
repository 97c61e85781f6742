// SPDX-License-Identifier: MIT
// Times of the paper's Table 1, measured by its authors on a Radeon HD 6870 (Silvestre and Pereira,
// 'Cascaded Light Propagation Volumes using Spherical Radial Basis Functions').
#pragma once

#include <array>
#include <optional>
#include <string_view>

#include "options/stages.hpp"

namespace clpv::bench {

/// Times of one basis [ms]; cascades by rising size: 12.5, 25 and 50 m.
struct PublishedTimes {
  std::string_view basis;
  bool shadows;  ///< indirect shadows
  std::array<double, 3> injection, propagation;
  double light_buffer;
};

inline constexpr std::array<PublishedTimes, 6> kPublishedTimes{{
    {"sh2", true, {2.028, 2.292, 2.339}, {2.241, 2.565, 2.275}, 1.086},
    {"srbf4", true, {2.090, 2.314, 2.351}, {4.139, 4.974, 4.200}, 1.214},
    {"srbf8v2", true, {3.544, 4.488, 4.299}, {9.663, 10.602, 9.386}, 1.723},
    {"sh2", false, {2.025, 2.294, 2.340}, {1.957, 2.125, 1.986}, 1.135},
    {"srbf4", false, {2.086, 2.281, 2.344}, {3.183, 3.797, 3.177}, 1.206},
    {"srbf8v2", false, {3.511, 4.460, 4.276}, {7.427, 7.794, 7.019}, 1.721},
}};

/// Published time of a pass [ms]: inject_light and propagate per cascade, gather without a cascade.
/// Empty for everything that the table lacks, such as the injection of the geometry volume.
constexpr std::optional<double> published_ms(Pass pass, std::string_view basis, bool shadows,
                                             std::optional<int> cascade) {
  for (const PublishedTimes& times : kPublishedTimes) {
    if (times.basis != basis || times.shadows != shadows) continue;
    if (pass == Pass::gather && !cascade) return times.light_buffer;
    const bool listed =
        cascade && *cascade >= 0 && *cascade < static_cast<int>(times.injection.size());
    if (listed && pass == Pass::inject_light) return times.injection[*cascade];
    if (listed && pass == Pass::propagate) return times.propagation[*cascade];
  }
  return std::nullopt;
}

}  // namespace clpv::bench
