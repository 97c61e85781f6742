// SPDX-License-Identifier: MIT
// What a traced image shows: the same views as a rendered frame's, pixel by pixel.
#pragma once

#include "image/image.hpp"
#include "options/show.hpp"
#include "pathtracer/path_tracer.hpp"

namespace clpv::reference {

/// R, G, B, A of one view, units and meaning as in kernels/shared/shade.h: alpha 1 where there is a surface, else all 0.
Image traced_view(const TracedImage& traced, Show show);

}  // namespace clpv::reference
