// SPDX-License-Identifier: MIT
// What can be chosen of a frame, each choice an enumeration with its names on the command line, in files and in tables.
// Those that a basis knows are beside it: TransportKind, Blocking, LobeKind. Knows no OpenCL.
#pragma once

#include "support/named_enum.hpp"

namespace clpv {

enum class PresetName { best, paper };

template <>
inline constexpr auto kNames<PresetName> = name_list("best", "paper");

/// How volumes lie in memory, as kernels/volume/ has them. `image`: a 3-D image of RGBA texels, four coefficients each;
/// `aos`: the coefficients of a sample side by side; `soa`: a plane of samples a channel and coefficient; `tiled`: blocks
/// of 8 samples along x by all coefficients.
enum class Layout { image, aos, soa, tiled };

template <>
inline constexpr auto kNames<Layout> = name_list("image", "aos", "soa", "tiled");

enum class Storage { float32, float16 };

template <>
inline constexpr auto kNames<Storage> = name_list("float", "half");

struct VolumeFormat {
  Layout layout = Layout::soa;
  Storage storage = Storage::float32;
  bool operator==(const VolumeFormat&) const = default;
};

/// What cells hold while light travels. `coefficients`: the N of the basis. `fluxes`: what a face transport's cell
/// received through its six faces, whatever N is; the N coefficients come back at the end
/// (docs/method.md, 'Propagation').
enum class State { coefficients, fluxes };

template <>
inline constexpr auto kNames<State> = name_list("coefficients", "fluxes");

/// Where propagation's lobes are made.
enum class LobeTime {
  host,    ///< constants of the step's code
  kernel,  ///< made from each face's normal, read from memory, and rotated ones from a table
};

template <>
inline constexpr auto kNames<LobeTime> = name_list("host", "kernel");

/// How stages come by the values of SRBF functions.
enum class Evaluation { exact, table };

template <>
inline constexpr auto kNames<Evaluation> = name_list("exact", "table");

/// What kernels read look-up tables as.
enum class TableStorage { buffer, image };

template <>
inline constexpr auto kNames<TableStorage> = name_list("buffer", "image");

/// What blocks light on its way.
enum class Blockers {
  scene,  ///< the scene's triangles, whoever sees them
  seen,   ///< the surfels that lights' maps and the camera see
};

template <>
inline constexpr auto kNames<Blockers> = name_list("scene", "seen");

/// Which of the eight cells round a point light a surface.
enum class Gathering {
  all,
  visible,  ///< those that the scene's triangles do not hide from it
};

template <>
inline constexpr auto kNames<Gathering> = name_list("all", "visible");

/// How far off a surface it looks volumes up [cells]: half a cell, so that it is not lit by those behind it; closer where
/// those are told apart.
constexpr double usual_gather_offset(Gathering gathering) {
  switch (gathering) {
    case Gathering::all:
      return 0.5;
    case Gathering::visible:
      return 0.25;
  }
  return {};
}

/// Directions that light is swept along: 24 bins in so many parts (basis/sweep.hpp).
enum class Directions { of24, of96, of216, of384 };

template <>
inline constexpr auto kNames<Directions> = name_list("24", "96", "216", "384");

/// Parts of a bin along each of its edges.
constexpr int parts_of(Directions directions) {
  return 1 + static_cast<int>(directions);
}

/// Surfaces between a light and the surface seen.
enum class Bounces { one, two, all };

template <>
inline constexpr auto kNames<Bounces> = name_list("1", "2", "all");

enum class RsmFormat { float32, paper };  ///< paper: 32-bit depth, 8-bit normal and flux

template <>
inline constexpr auto kNames<RsmFormat> = name_list("float", "paper");

}  // namespace clpv
