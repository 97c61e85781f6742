// SPDX-License-Identifier: MIT
// Geometry volumes: blocking potential at every corner of the light cells, N coefficients, one
// channel.
#include "volume/coefficients.h"
#define CLPV_VOLUME geometry
#define CLPV_VOLUME_N (CLPV_GRID + 1)
#define CLPV_VOLUME_CELL Coefficients
#define CLPV_VOLUME_COUNT CLPV_N
#include "volume/instance.h"
