// SPDX-License-Identifier: MIT
// Every tolerance between a kernel and its twin, in one table, each with its reason.
#pragma once

#include <string_view>

namespace clpv::reference {

struct Tolerance {
  std::string_view stage;
  double allowed;  ///< largest |kernel - twin| over the largest |twin| of the compared field, unless said
                   ///< otherwise
  std::string_view reason;
};

inline constexpr Tolerance kTolerances[] = {
    {"sizes", 0, "bytes: host and device read the same buffers"},
    {"rasterize", 2e-5,
     "of the field's largest value, away from edges: float32 positions on a triangle, worst where it is seen "
     "at a "
     "slant, through a texture's steps; measured 2.1e-6"},
    {"rasterize-edges", 5e-3,
     "share of pixels that differ where a hair's breadth decides (reference/rasterize.hpp): a float32 corner "
     "may "
     "snap to the next 1/256 pixel; measured 7e-4, one pixel"},
    {"emit", 2e-5,
     "of the largest flux and position, apart from what rounding can decide (reference/emit.hpp): float32 "
     "places in a "
     "texture, and its mean over 64 looks"},
    {"inject", 2e-5,
     "of the functions' values in 26 directions: float32 rounding times the square root of the Gram matrix's "
     "condition number; measured 2e-7 (sh2) to 5e-6 (srbf14)"},
    {"inject-rotated", 5e-5,
     "as inject; sums of N products with the coefficients of the lobe towards +z, large and of mixed sign "
     "where the "
     "Gram matrix is ill-conditioned; measured 3e-7 (srbf4) to 1.7e-5 (srbf14)"},
    {"block", 0,
     "shares of samples outside what rounding can decide (reference/block.hpp); 64ths are exact in any "
     "format"},
    {"block-half", 0, "as block"},
    {"reflect", 1e-3,
     "areas in faces, apart from what rounding can decide (reference/reflect.hpp): colours in 4096ths, and a "
     "texture's steps "
     "magnify what float32 moves a sample by"},
    {"reflect-half", 2e-3, "as reflect, and numbers of 11 bits"},
    {"see", 0, "hidden cells of a point, apart from those that rounding can decide (reference/see.hpp)"},
    {"propagate", 2e-5,
     "float32 sums of 30 faces over 8 steps; measured drift 1.5e-6 (sh2) to 6.4e-6 (srbf14)"},
    {"propagate-run-time-lobes", 2e-4,
     "of coefficients, as propagate; lobes made in float32 err in coefficients that hardly change the "
     "function where the "
     "Gram matrix is ill-conditioned; measured 1.1e-7 (sh2), 3.8e-6 (srbf8v3), 6.1e-5 (srbf14)"},
    {"propagate-half", 4e-3,
     "numbers of 11 bits: each step rounds what travels and the sum by up to 2^-12 of themselves; measured "
     "1.4e-3"},
    {"inject-half", 4e-3,
     "numbers of 11 bits, rounded once a surface, times the square root of the Gram "
     "matrix's condition number; measured 5e-4"},
    {"gather-half", 2e-3, "numbers of 11 bits, rounded once, N of mixed sign a direction; measured 4e-4"},
    {"gather-filter", 2e-2,
     "a device's image filter may keep 8 bits of a weight, along each of three axes, between neighbours as "
     "far apart as random ones are; PoCL, which filters in float, measured 1e-6"},
    {"gather-filter-half", 2e-2, "as gather-filter: numbers of 11 bits add a tenth of that"},
    {"sweep", 5e-6, "float32 sums of eight products a cell, over as many cells as light crosses"},
    {"sweep-half", 4e-3,
     "numbers of 11 bits: injected light, transmittance, the sums, and what is made of them; light on its "
     "way is float32"},
    {"bounce", 1e-5, "as sweep, twice, and as often as light bounces on"},
    {"bounce-half", 1e-2, "as sweep-half, twice over"},
    {"gather-visible", 1e-3, "as gather, over the share of weight that is seen, 1/64 at least"},
    {"gather-visible-half", 2e-2, "as gather-half, over that share"},
    {"shade", 5e-6,
     "float32 light angles and distances; a shadow filter weighs texels by coordinates good to 1e-6 of its "
     "side"},
    {"gather", 2e-5,
     "float32 trilinear weights and N products of mixed sign, srbf14's coefficients ten times the light they "
     "add up to; a "
     "position 1e-6 m off at 10 m moves them too; measured 1.1e-5 (srbf14), 4e-6 (others)"},
};

/// One entry a stage: a second one would never be looked at.
constexpr bool stages_are_distinct() {
  for (const Tolerance& a : kTolerances) {
    for (const Tolerance& b : kTolerances) {
      if (&a != &b && a.stage == b.stage) return false;
    }
  }
  return true;
}
static_assert(stages_are_distinct());

/// The tolerance of a stage. A stage without an entry allows nothing.
constexpr double tolerance(std::string_view stage) {
  for (const Tolerance& entry : kTolerances) {
    if (entry.stage == stage) return entry.allowed;
  }
  return 0.0;
}

/// The same for volumes of numbers in half.
constexpr double half_tolerance(std::string_view stage) {
  for (const Tolerance& entry : kTolerances) {
    if (entry.stage.starts_with(stage) && entry.stage.substr(stage.size()) == "-half") return entry.allowed;
  }
  return 0.0;
}

}  // namespace clpv::reference
