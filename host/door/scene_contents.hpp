// SPDX-License-Identifier: MIT
// What a SceneFile holds.
#pragma once

#include "clpv/scene.hpp"
#include "scene/load.hpp"

namespace clpv {

struct SceneFile::Contents {
  MovingScene moving;  ///< at 0 s
};

}  // namespace clpv
