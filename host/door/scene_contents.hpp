// SPDX-License-Identifier: MIT
// What a SceneFile holds.
#pragma once

#include "clpv/scene.hpp"
#include "scene/scene.hpp"

namespace clpv {

struct SceneFile::Contents {
  Scene scene;
};

}  // namespace clpv
