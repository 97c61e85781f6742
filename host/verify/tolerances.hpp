// SPDX-License-Identifier: MIT
// Every tolerance between a kernel and its CPU reference, in one table, each with its reason.
#pragma once

#include <algorithm>
#include <iterator>
#include <string_view>

#include "options/choices.hpp"

namespace clpv::reference {

struct Tolerance {
  std::string_view stage;
  double
      allowed;  ///< largest |kernel - CPU reference| over the largest |CPU reference| of the compared field, unless said otherwise
  double half = 0;  ///< the same where volumes hold numbers of 11 bits (Storage::float16)
};

inline constexpr Tolerance kTolerances[] = {
    // Bytes: host and device read the same buffers.
    {"sizes", 0},
    // Of the field's largest value, away from edges: float32 positions on a triangle, worst where it is seen at a slant,
    // through a texture's steps; measured 2.1e-6.
    {"rasterize", 2e-5},
    // Share of pixels that differ because of rounding (reference/rasterize.hpp): a float32 corner may snap to the
    // next 1/256 pixel; measured 7e-4, one pixel.
    {"rasterize-edges", 5e-3},
    // Of the largest flux and position, apart from what rounding can decide (reference/emit.hpp): float32 places in a
    // texture, and its mean over 64 looks.
    {"emit", 2e-5},
    // Of the functions' values in 26 directions: float32 rounding times the square root of the Gram matrix's condition
    // number; measured 2e-7 (sh2) to 5e-6 (srbf14). Halves are rounded once a surface; measured 5e-4.
    {"inject", 2e-5, 4e-3},
    // As inject; sums of N products with the coefficients of the lobe towards +z, large and of mixed sign where the Gram
    // matrix is ill-conditioned; measured 3e-7 (srbf4) to 1.7e-5 (srbf14).
    {"inject-rotated", 5e-5},
    // Shares of samples outside what rounding can decide (reference/blockers.hpp); 64ths are exact in any format.
    {"blockers", 0, 0},
    // Areas in faces, apart from what rounding can decide (reference/reflectors.hpp): colours in 4096ths, and a texture's steps
    // magnify what float32 moves a sample by.
    {"reflectors", 1e-3, 2e-3},
    // Hidden cells of a point, apart from those that rounding can decide (reference/visibility.hpp).
    {"visibility", 0},
    // float32 sums of 30 faces over 8 steps; measured drift 1.5e-6 (sh2) to 6.4e-6 (srbf14). In halves each step rounds what
    // travels and the sum by up to 2^-12 of themselves; measured 1.4e-3.
    {"propagate", 2e-5, 4e-3},
    // Of coefficients, as propagate; lobes made in float32 err in coefficients that hardly change the function where the
    // Gram matrix is ill-conditioned; measured 1.1e-7 (sh2), 3.8e-6 (srbf8v3), 6.1e-5 (srbf14).
    {"propagate-run-time-lobes", 2e-4},
    // float32 sums of eight products a cell, over as many cells as light crosses. In halves are injected light,
    // transmittance, the sums, and what is made of them; light on its way is float32.
    {"sweep", 5e-6, 4e-3},
    // As sweep, twice, and as often as light bounces on.
    {"bounce", 1e-5, 1e-2},
    // float32 trilinear weights and N products of mixed sign, srbf14's coefficients ten times the light they add up to; a
    // position 1e-6 m off at 10 m moves them too; measured 1.1e-5 (srbf14), 4e-6 (others). Halves are rounded once, N of
    // mixed sign a direction; measured 4e-4.
    {"gather", 2e-5, 2e-3},
    // A device's image filter may keep 8 bits of a weight, along each of three axes, between neighbours as far apart as
    // random ones are; PoCL, which filters in float, measured 1e-6. Halves add a tenth of that.
    {"gather-filter", 2e-2, 2e-2},
    // As gather, over the share of weight that is seen, 1/64 at least.
    {"gather-visible", 1e-3, 2e-2},
    // float32 light angles and distances; a shadow filter weighs texels by coordinates good to 1e-6 of its side.
    {"shade", 5e-6},
};

/// The tolerance of a stage in the table, for volumes of numbers stored as `storage`. Any other stage is allowed nothing.
constexpr double tolerance(std::string_view stage, Storage storage = Storage::float32) {
  const auto* found = std::ranges::find(kTolerances, stage, &Tolerance::stage);
  if (found == std::end(kTolerances)) return 0;
  return storage == Storage::float16 ? found->half : found->allowed;
}

}  // namespace clpv::reference
