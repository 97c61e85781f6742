// SPDX-License-Identifier: MIT
// The stages there are, and what the timeline tells apart of them: the one list for `clpv check`, the times of a frame and
// the benchmarks. A new one that is not everywhere it must be does not compile.
#pragma once

#include <string_view>

namespace clpv {

/// As the house files them: kernels, what launches them, twin, check and test of one stem. `sizes`, the layout of structs
/// that both sides share, is none of a frame's: it is checked before all others.
enum class Stage {
  sizes,
  rasterize,
  emit,
  inject,
  block,
  reflect,
  propagate,
  sweep,
  bounce,
  see,
  gather,
  shade
};

constexpr std::string_view name_of(Stage stage) {
  switch (stage) {
    case Stage::sizes:
      return "sizes";
    case Stage::rasterize:
      return "rasterize";
    case Stage::emit:
      return "emit";
    case Stage::inject:
      return "inject";
    case Stage::block:
      return "block";
    case Stage::reflect:
      return "reflect";
    case Stage::propagate:
      return "propagate";
    case Stage::sweep:
      return "sweep";
    case Stage::bounce:
      return "bounce";
    case Stage::see:
      return "see";
    case Stage::gather:
      return "gather";
    case Stage::shade:
      return "shade";
  }
  return {};
}

/// A part of a frame with a time of its own: a stage, or what it does for one purpose. `whole`: what a benchmark times as
/// one, whatever it launches.
enum class Pass {
  rasterize_camera,
  rasterize_shadow,  ///< a light
  rasterize_rsm,     ///< a cascade and light
  emit,              ///< points of surfaces that glow
  inject_light,      ///< a cascade, as are the next five
  inject_geometry,
  block,
  reflect,
  propagate,  ///< in steps, or by a sweep and its bounces
  see,        ///< a cascade
  gather,
  shade,
  whole,
};

constexpr std::string_view name_of(Pass pass) {
  switch (pass) {
    case Pass::rasterize_camera:
      return "rasterize-camera";
    case Pass::rasterize_shadow:
      return "rasterize-shadow";
    case Pass::rasterize_rsm:
      return "rasterize-rsm";
    case Pass::emit:
      return "emit";
    case Pass::inject_light:
      return "inject-light";
    case Pass::inject_geometry:
      return "inject-geometry";
    case Pass::block:
      return "block";
    case Pass::reflect:
      return "reflect";
    case Pass::propagate:
      return "propagate";
    case Pass::see:
      return "see";
    case Pass::gather:
      return "gather";
    case Pass::shade:
      return "shade";
    case Pass::whole:
      return "whole";
  }
  return {};
}

}  // namespace clpv
