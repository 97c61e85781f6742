// SPDX-License-Identifier: MIT
// What is counted of the triangles that a light cell's sides are made of, as kernels/reflectors.cl and face_albedo.cl see it.
#ifndef CLPV_SHARED_REFLECTORS_H
#define CLPV_SHARED_REFLECTORS_H

// Links that a surface can face: towards +x, -x, +y, -y, +z, -z.
#define CLPV_SIDES 6

// Words of a side: two of samples covered, how often samples were, and what they reflect in red, green and blue.
#define CLPV_SIDE_WORDS 6
#define CLPV_SIDE_COUNT 2
#define CLPV_SIDE_COLOUR 3

// In the last three, a sample that reflects everything. 2^14 triangles that fill a side one behind another fit.
#define CLPV_REFLECT_UNIT 4096.0f

#endif
