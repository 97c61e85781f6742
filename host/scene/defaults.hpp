// SPDX-License-Identifier: MIT
// What is added to a scene where nothing is given: a camera that frames it, a sun.
#pragma once

#include "scene/notes.hpp"
#include "scene/scene.hpp"

namespace clpv {

/// To a scene whose bounding box is known; each addition gets a note. `lights_given`: an empty list of lights is meant, as
/// darkness.
void add_defaults(Scene& scene, bool lights_given, Notes& notes);

}  // namespace clpv
