// SPDX-License-Identifier: MIT
#include "options/scene_options.hpp"

#include <cmath>

#include "scene/load.hpp"
#include "support/error.hpp"

namespace clpv {
namespace {

// The coarsest cascade usually has 32 cells along each axis. The 26 around the eye receive full
// light, and the next two fade out. 24 cells leave room for moving parts.
constexpr double kRoom = 32.0 / 24;
// Relative to the smallest edge that encloses the scene: it spans 1 of 4 cells.
constexpr double kFarTooLarge = 4;

}  // namespace

double fitting_cascade_size(const SceneData& scene, int count, double size) {
  const double just = std::ldexp(2 * scene.reach() * kRoom, 1 - count);
  return just > 0 && (size < just || size > kFarTooLarge * just) ? just : size;
}

RenderOptions resolve_options(const OptionValues& given, const SceneData& scene) {
  RenderOptions options;
  if (const auto preset = given.find("preset"); preset != given.end())
    set_option(options, "preset", preset->second);
  if (scene.cascade_size) options.cascade_size = *scene.cascade_size;
  if (scene.cascades) options.cascades = *scene.cascades;
  if (given.contains("basis") && given.contains("centres"))
    throw Error(ExitCode::usage, "basis and centres are both given; allowed: one of them");
  for (const auto& [name, value] : given) {
    if (name != "preset") set_option(options, name, value);
  }
  if (!given.contains("gather-offset")) options.gather_offset = usual_gather_offset(options.gather);
  if (options.bounces == Bounces::automatic)
    options.bounces = options.transport == TransportKind::sweep ? Bounces::all : Bounces::one;
  options.near = options.traces_near() ? Near::traced : Near::off;
  if (is_bare_model(scene) && !given.contains("cascade-size"))
    options.cascade_size = fitting_cascade_size(scene, options.cascades, options.cascade_size);
  return options;
}

}  // namespace clpv
