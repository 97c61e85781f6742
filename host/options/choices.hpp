// SPDX-License-Identifier: MIT
// What can be chosen of a frame, each choice an enumeration with its names on the command line, in files and in tables.
// Those that a basis knows are beside it: TransportKind, Blocking, LobeKind. Knows no OpenCL.
#pragma once

#include <string_view>

namespace clpv {

enum class PresetName { best, paper };

constexpr std::string_view name_of(PresetName preset) {
  switch (preset) {
    case PresetName::best:
      return "best";
    case PresetName::paper:
      return "paper";
  }
  return {};
}

/// How volumes lie in memory, as kernels/volume/ has them. `image`: a 3-D image of RGBA texels, four coefficients each;
/// `aos`: the coefficients of a sample side by side; `soa`: a plane of samples a channel and coefficient; `tiled`: blocks
/// of 8 samples along x by all coefficients.
enum class Layout { image, aos, soa, tiled };

constexpr std::string_view name_of(Layout layout) {
  switch (layout) {
    case Layout::image:
      return "image";
    case Layout::aos:
      return "aos";
    case Layout::soa:
      return "soa";
    case Layout::tiled:
      return "tiled";
  }
  return {};
}

enum class Storage { float32, float16 };

constexpr std::string_view name_of(Storage storage) {
  switch (storage) {
    case Storage::float32:
      return "float";
    case Storage::float16:
      return "half";
  }
  return {};
}

struct VolumeFormat {
  Layout layout = Layout::soa;
  Storage storage = Storage::float32;
  bool operator==(const VolumeFormat&) const = default;
};

/// What cells hold while light travels. `coefficients`: the N of the basis. `fluxes`: what a face transport's cell
/// received through its six faces, whatever N is; the N coefficients come back at the end
/// (docs/method.md, 'Propagation').
enum class State { coefficients, fluxes };

constexpr std::string_view name_of(State state) {
  switch (state) {
    case State::coefficients:
      return "coefficients";
    case State::fluxes:
      return "fluxes";
  }
  return {};
}

/// Where propagation's lobes are made.
enum class LobeTime {
  host,    ///< constants of the step's code
  kernel,  ///< made from each face's normal, read from memory, and rotated ones from a table
};

constexpr std::string_view name_of(LobeTime time) {
  switch (time) {
    case LobeTime::host:
      return "host";
    case LobeTime::kernel:
      return "kernel";
  }
  return {};
}

/// How stages come by the values of SRBF functions.
enum class Evaluation { exact, table };

constexpr std::string_view name_of(Evaluation evaluation) {
  switch (evaluation) {
    case Evaluation::exact:
      return "exact";
    case Evaluation::table:
      return "table";
  }
  return {};
}

/// What kernels read look-up tables as.
enum class TableStorage { buffer, image };

constexpr std::string_view name_of(TableStorage storage) {
  switch (storage) {
    case TableStorage::buffer:
      return "buffer";
    case TableStorage::image:
      return "image";
  }
  return {};
}

/// What blocks light on its way.
enum class Blockers {
  scene,  ///< the scene's triangles, whoever sees them
  seen,   ///< the surfels that lights' maps and the camera see
};

constexpr std::string_view name_of(Blockers blockers) {
  switch (blockers) {
    case Blockers::scene:
      return "scene";
    case Blockers::seen:
      return "seen";
  }
  return {};
}

/// Which of the eight cells round a point light a surface.
enum class Gathering {
  all,
  visible,  ///< those that the scene's triangles do not hide from it
};

constexpr std::string_view name_of(Gathering gathering) {
  switch (gathering) {
    case Gathering::all:
      return "all";
    case Gathering::visible:
      return "visible";
  }
  return {};
}

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

constexpr std::string_view name_of(Directions directions) {
  switch (directions) {
    case Directions::of24:
      return "24";
    case Directions::of96:
      return "96";
    case Directions::of216:
      return "216";
    case Directions::of384:
      return "384";
  }
  return {};
}

/// Parts of a bin along each of its edges.
constexpr int parts_of(Directions directions) {
  return 1 + static_cast<int>(directions);
}

/// Surfaces between a light and the surface seen.
enum class Bounces { one, two, all };

constexpr std::string_view name_of(Bounces bounces) {
  switch (bounces) {
    case Bounces::one:
      return "1";
    case Bounces::two:
      return "2";
    case Bounces::all:
      return "all";
  }
  return {};
}

enum class RsmFormat { float32, paper };  ///< paper: 32-bit depth, 8-bit normal and flux

constexpr std::string_view name_of(RsmFormat format) {
  switch (format) {
    case RsmFormat::float32:
      return "float";
    case RsmFormat::paper:
      return "paper";
  }
  return {};
}

}  // namespace clpv
