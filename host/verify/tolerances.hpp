// SPDX-License-Identifier: MIT
// Table of the tolerances between kernels and CPU references, each with its reason.
#pragma once

#include <algorithm>
#include <iterator>
#include <string_view>

#include "options/choices.hpp"

namespace clpv::verify {

struct Tolerance {
  std::string_view stage;
  double allowed;   ///< largest |kernel - CPU reference| over the largest |CPU reference| of the
                    ///< field, unless noted
  double half = 0;  ///< the same for volumes of numbers with 11 bits (Storage::float16)
};

inline constexpr Tolerance kTolerances[] = {
    // Bytes: host and device read the same buffers.
    {"sizes", 0},
    // Relative to the field's largest value, away from edges: float32 positions on a triangle. The
    // error is largest at grazing angles, through texture steps; measured 2.1e-6.
    {"rasterize", 2e-5},
    // Share of pixels that differ because of rounding (reference/rasterize.hpp): a float32 corner
    // may snap to the next 1/256 pixel; measured 7e-4, one pixel.
    {"rasterize-edges", 5e-3},
    // Relative to the largest flux and position, except where rounding can decide
    // (reference/inject.hpp): float32 texture coordinates, and the texture's mean over 64 samples.
    {"emit", 2e-5},
    // Values of the functions in 26 directions: float32 rounding times the square root of the Gram
    // matrix's condition number; measured 2e-7 (sh2) to 5e-6 (srbf14). float16 rounds once per
    // surface; measured 5e-4.
    {"inject", 2e-5, 4e-3},
    // As inject. Sums N products with the coefficients of the lobe towards +z, which are large and
    // of mixed sign if the Gram matrix is ill-conditioned; measured 3e-7 (srbf4) to 2.1e-5
    // (srbf14). Leaves out directions for which a table's index lies on an entry
    // (rounding_decides): kernels rotate in float, and one entry more or less is no error.
    {"inject-rotated", 5e-5},
    // As inject, where normals may lie along the axes: with the centres of srbf8, t is then 1 or
    // 1/3, which lies on an entry of a table of 256, and a device's rounding decides for one entry
    // or the next. Measured 9.3e-3 (NVIDIA H200, srbf8v2); PoCL rounds like the reference.
    {"inject-on-entries", 2e-2, 2e-2},
    // Shares of samples, except where rounding can decide (reference/blockers.hpp); 64ths are exact
    // in any format.
    {"blockers", 0, 0},
    // Areas on faces, except where rounding can decide (reference/blockers.hpp). Colours are in
    // 4096ths, and texture steps magnify float32 errors of sample positions.
    {"reflectors", 1e-3, 2e-3},
    // Occluded cells of a point, except where rounding can decide (reference/blockers.hpp).
    {"visibility", 0},
    // float32 sums of 30 faces over 8 steps; measured drift 1.5e-6 (sh2) to 6.4e-6 (srbf14). With
    // float16, each step rounds propagated light and its sum, with relative error up to 2^-12;
    // measured 1.4e-3.
    {"propagate", 2e-5, 4e-3},
    // Coefficients, as propagate. With an ill-conditioned Gram matrix, float32 lobes have errors in
    // coefficients that hardly change the function; measured 1.1e-7 (sh2), 3.8e-6 (srbf8v3), 8.9e-5
    // (srbf14). Leaves out nothing: rotations to the axes are exact, and kernel and reference round
    // each product and sum of the index alike (dot_in_float).
    {"propagate-run-time-lobes", 2e-4},
    // float32 sums of eight products per cell, over all cells along the light's path. float16
    // stores injected light, transmittance, sums and results; light inside the sweep is float32.
    {"sweep", 5e-6, 4e-3},
    // As sweep, for up to nine sweeps in a row and the series of bounces, each over a furnace that
    // may be small; measured 1.4e-5 (nine sweeps in a medium), 4.8e-5 where the series multiplies
    // the
    // difference of two sweeps that are nearly equal.
    {"bounce", 1e-4, 1e-2},
    // float32 trilinear weights and N products of mixed sign; srbf14 coefficients are ten times
    // their sum. A position error of 1e-6 m at 10 m adds to it. Measured 1.1e-5 (srbf14), 4e-6
    // (others). float16 rounds once, for N values of mixed sign per direction; measured 4e-4.
    // Leaves out normals as inject-rotated does.
    {"gather", 2e-5, 2e-3},
    // A device's image filter may use 8-bit weights along each of three axes, and random neighbours
    // differ a lot. PoCL, which filters in float, measured 1e-6. float16 adds 10 % of that.
    {"gather-filter", 2e-2, 2e-2},
    // As gather, divided by the share of visible weight, at least 1/64.
    {"gather-visible", 1e-3, 2e-2},
    // float32 positions and directions of rays, and sums over 100 of them; pixels that rounding may
    // decide are left out; measured 1e-6. float16 as gather.
    {"near", 1e-4, 2e-2},
    // exp and log of float32, and ends of rays that differ by rounding among pixels whose weight
    // falls steeply.
    {"medium", 1e-4, 2e-2},
    // float32 light angles and distances; shadow filter weights use coordinates accurate to 1e-6 of
    // the map's side.
    {"shade", 5e-6},
};

/// Returns a stage's tolerance for volumes stored as `storage`; 0 for stages without an entry.
constexpr double tolerance(std::string_view stage, Storage storage = Storage::float32) {
  const auto* found = std::ranges::find(kTolerances, stage, &Tolerance::stage);
  if (found == std::end(kTolerances)) return 0;
  return storage == Storage::float16 ? found->half : found->allowed;
}

}  // namespace clpv::verify
