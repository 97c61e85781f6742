// SPDX-License-Identifier: MIT
#include "image/primaries.hpp"

#include <fmt/format.h>

#include <cmath>
#include <glm/glm.hpp>

namespace clpv {
namespace {

// Standards state three or four digits.
constexpr double kSameChromaticity = 1e-3;
// Smaller determinants amplify the digits of the chromaticities more than a hundred times.
constexpr double kMinDeterminant = 1e-6;

/// Cone responses of CIE XYZ (Lam 1985, Metamerism and Colour Constancy), in columns.
const glm::dmat3 kBradford(0.8951, -0.7502, 0.0389, 0.2664, 1.7135, -0.0685, -0.1614, 0.0367,
                           1.0296);

/// XYZ of luminance 1.
glm::dvec3 xyz_of(double x, double y) {
  return {x / y, 1, (1 - x - y) / y};
}

glm::dvec3 white_of(const Chromaticities& c) {
  return xyz_of(c[6], c[7]);
}

/// Matrix from RGB to XYZ (SMPTE RP 177): columns are the primaries, scaled so that they sum to
/// white.
std::optional<glm::dmat3> to_xyz(const Chromaticities& c) {
  const auto primary = [&](int i) {
    return glm::dvec3(c[2 * i], c[2 * i + 1], 1 - c[2 * i] - c[2 * i + 1]);
  };
  const glm::dmat3 primaries(primary(0), primary(1), primary(2));
  if (!(std::abs(glm::determinant(primaries)) > kMinDeterminant && c[7] > kMinDeterminant))
    return std::nullopt;
  const glm::dvec3 scale = glm::inverse(primaries) * white_of(c);
  return glm::dmat3(scale.x * primaries[0], scale.y * primaries[1], scale.z * primaries[2]);
}

}  // namespace

bool is_rec709(const Chromaticities& chromaticities) {
  for (std::size_t i = 0; i < kRec709.size(); ++i)
    if (!(std::abs(chromaticities[i] - kRec709[i]) < kSameChromaticity)) return false;
  return true;
}

std::optional<glm::dmat3> to_rec709(const Chromaticities& chromaticities) {
  const auto from = to_xyz(chromaticities);
  if (!from) return std::nullopt;
  const glm::dvec3 gain = kBradford * white_of(kRec709) / (kBradford * white_of(chromaticities));
  const glm::dmat3 adapt =
      glm::inverse(kBradford) * glm::dmat3(gain.x, 0, 0, 0, gain.y, 0, 0, 0, gain.z) * kBradford;
  const glm::dmat3 matrix = glm::inverse(*to_xyz(kRec709)) * adapt * *from;
  for (int column = 0; column < 3; ++column)
    if (!std::isfinite(glm::dot(matrix[column], glm::dvec3(1)))) return std::nullopt;
  return matrix;
}

std::string text_of(const Chromaticities& c) {
  return fmt::format("{:.4g},{:.4g} {:.4g},{:.4g} {:.4g},{:.4g}, white {:.4g},{:.4g}", c[0], c[1],
                     c[2], c[3], c[4], c[5], c[6], c[7]);
}

}  // namespace clpv
