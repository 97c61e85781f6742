// SPDX-License-Identifier: MIT
#include "pipeline/frame/scene_options.hpp"

#include "basis/basis.hpp"
#include "pipeline/frame/cascade.hpp"
#include "scene/load.hpp"
#include "support/error.hpp"

namespace clpv {

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
  options.near = options.traces_near() ? Near::traced : Near::off;
  if (is_bare_model(scene) && !given.contains("cascade-size"))
    options.cascade_size = fitting_cascade_size(scene, options.cascades, options.cascade_size);
  if (!options.centres.empty()) options.basis = make_basis(options)->name();
  return options;
}

}  // namespace clpv
