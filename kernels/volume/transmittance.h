// SPDX-License-Identifier: MIT
// Transmittance volumes: for every light cell the share in [0, 1] of light that each way into it lets through.
// CLPV_GRID is the number of cells along each axis; the struct Ways and CLPV_EACH_WAY come from the host.
#define CLPV_VOLUME transmittance
#define CLPV_VOLUME_N CLPV_GRID
#define CLPV_VOLUME_CELL Ways
#define CLPV_VOLUME_EACH CLPV_EACH_WAY
#define CLPV_VOLUME_COUNT CLPV_WAYS
#include "volume/instance.h"
