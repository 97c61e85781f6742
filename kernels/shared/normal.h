// SPDX-License-Identifier: MIT
// Geometric normal of a camera's pixel, in the fourth number of its shading normal; shared by host
// and kernels.
//
// The triangle's normal n_g decides which side light comes from, and along which axis receivers,
// rays and lookups are lifted; the shading normal n_s, interpolated from the vertices, weighs:
//   E = L max(0, n_s . w)   for n_g . w > 0, else 0
// n_g is stored as a whole number below 2^24, by its octahedral map (Cigolle et al., 'A Survey of
// Efficient Representations for Independent Unit Vectors', JCGT 3(2), 2014):
//   (u, v) = (x, y) / (|x| + |y| + |z|), for z < 0 ((1 - |y|) sign x, (1 - |x|) sign y)
//   number = (CLPV_NORMAL_STEPS u + CLPV_NORMAL_ZERO) + CLPV_NORMAL_BASE (the same of v)
// 0: n_g = n_s. The error is below 1e-3 rad.
#pragma once

#define CLPV_NORMAL_STEPS 2047.0f
#define CLPV_NORMAL_ZERO 2048.0f
#define CLPV_NORMAL_BASE 4096.0f

// Minimum cosine at which both normals count as equal; and minimum cosine (20 degrees) at which
// lookups and rays are lifted along n_s: on round meshes n_s changes smoothly from triangle to
// triangle.
#define CLPV_SAME_NORMAL 0.999999f
#define CLPV_SAME_LIFT 0.94f
