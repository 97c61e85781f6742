// SPDX-License-Identifier: MIT
// Enumerations of render options, with their names on the command line and in files. TransportKind,
// Blocking and LobeKind are in basis/. Independent of OpenCL.
#pragma once

#include "support/named_enum.hpp"

namespace clpv {

enum class PresetName { best, fast, fine, paper };

template <>
inline constexpr auto kNames<PresetName> = name_list("best", "fast", "fine", "paper");

/// Memory layout of volumes (kernels/volume/). `image`: 3-D image of RGBA texels, four coefficients
/// per texel. `aos`: all coefficients of a sample are adjacent. `soa`: one array of samples per
/// channel and coefficient. `tiled`: blocks of 8 samples along x times all coefficients.
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

/// Where the lobes of propagation are computed.
enum class LobeTime {
  host,    ///< on the host: constants in the kernel text
  kernel,  ///< in the kernel from the face's normal; rotated lobes from a table
};

template <>
inline constexpr auto kNames<LobeTime> = name_list("host", "kernel");

/// Evaluation of SRBF functions: exact, or from tables in a buffer or an image.
enum class Evaluation { exact, buffer, image };

template <>
inline constexpr auto kNames<Evaluation> = name_list("exact", "buffer", "image");

/// Storage of look-up tables.
enum class TableStorage { buffer, image };

template <>
inline constexpr auto kNames<TableStorage> = name_list("buffer", "image");

/// Source of blockers, which cause indirect shadows.
enum class Blockers {
  scene,  ///< all triangles of the scene
  seen,   ///< surfels of RSMs and G-buffer, as published
  none,
};

template <>
inline constexpr auto kNames<Blockers> = name_list("scene", "seen", "none");

/// Which of the eight nearest cells light a surface.
enum class Gathering {
  all,
  visible,  ///< cells that no triangle hides from the surface
};

template <>
inline constexpr auto kNames<Gathering> = name_list("all", "visible");

/// Default distance of the look-up from the surface [cells]. Half a cell avoids light from behind
/// the surface; hidden cells have no weight with `visible`, so the look-up can be closer.
constexpr double usual_gather_offset(Gathering gathering) {
  switch (gathering) {
    case Gathering::all:
      return 0.5;
    case Gathering::visible:
      return 0.25;
  }
  return {};
}

/// Final gather of light from surfaces nearer than a cell.
enum class Near {
  automatic,  ///< traced with a sweep, else off
  off,        ///< light of the volumes only
  traced,     ///< rays against the scene's triangles
};

template <>
inline constexpr auto kNames<Near> = name_list("auto", "off", "traced");

/// Pixels whose near field is traced: one of 1 x 1, 2 x 2, 4 x 4 or 8 x 8. `automatic`: about as
/// many as an image of 240 x 135 pixels has.
enum class NearSize { automatic, full, half, quarter, eighth };

template <>
inline constexpr auto kNames<NearSize> = name_list("auto", "full", "half", "quarter", "eighth");

/// Rays of each of these pixels.
enum class NearRays { of2, of4, of8, of16, of64 };

template <>
inline constexpr auto kNames<NearRays> = name_list("2", "4", "8", "16", "64");

/// Number of sweep directions: 24 bins of 1, 4, 9 or 16 parts (basis/sweep.hpp).
enum class Directions { of24, of96, of216, of384 };

template <>
inline constexpr auto kNames<Directions> = name_list("24", "96", "216", "384");

/// Returns the number of parts along each edge of a bin.
constexpr int parts_of(Directions directions) {
  return 1 + static_cast<int>(directions);
}

/// Number of indirect bounces: surfaces between a light and the visible surface. automatic: all
/// with a sweep, else one; resolve_options() replaces it, and stages take it as one.
enum class Bounces { automatic, one, two, all };

template <>
inline constexpr auto kNames<Bounces> = name_list("auto", "1", "2", "all");

enum class RsmFormat { float32, paper };  ///< paper: 32-bit depth, 8-bit normal and flux

template <>
inline constexpr auto kNames<RsmFormat> = name_list("float", "paper");

}  // namespace clpv
