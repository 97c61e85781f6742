// SPDX-License-Identifier: MIT
// Allowed outputs of a comparison, number by number, for the capsule that a session records.
// Without a recording these functions do nothing.
#pragma once

#include <functional>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "device/session.hpp"
#include "pipeline/raster/surface.hpp"
#include "volume/volume.hpp"

namespace clpv::verify {

/// Returns ranges about `expected`; a NaN there allows any value. `allowed`: share of the largest
/// |expected|.
Ranges ranges_about(std::span<const double> expected, double allowed);

/// `ranges` in Volume's host order.
void expect(Session& session, const Volume& volume, const Ranges& ranges);

/// As compare_pixels().
void expect_pixels(Session& session, const Buffer& pixels, std::span<const double> expected,
                   double allowed, std::size_t every = 1);

/// As compare_functions(): a coefficient outside its range makes the function differ by more than
/// allowed in one of the compared directions. Coefficients that the directions do not determine may
/// have any value.
void expect_functions(Session& session, const Volume& volume, std::span<const double> expected,
                      std::span<const double> other,
                      const std::function<std::vector<double>(const glm::dvec3&)>& weights,
                      double allowed);

/// `allowed`: share of the largest depth, at least 1 m. Pixels that are `uncertain` may have any.
void expect_depths(Session& session, const Buffer& buffer, const std::vector<float>& expected,
                   const std::vector<bool>& uncertain, double allowed);

/// Fields of the image that are empty are not compared, nor pixels that are `uncertain`. Requires
/// RsmFormat::float32. `allowed`: share of each field's largest value.
void expect_surface(Session& session, const Surface& surface, const SurfaceImage& expected,
                    const std::vector<bool>& uncertain, double allowed);

}  // namespace clpv::verify
