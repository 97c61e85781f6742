// SPDX-License-Identifier: MIT
// Transmittance volumes: for every light cell the share in [0, 1] of light that each link into it lets through.
// CLPV_GRID is the number of cells along each axis; the struct Links and CLPV_EACH_LINK come from the host.
#define CLPV_VOLUME transmittance
#define CLPV_VOLUME_N CLPV_GRID
#define CLPV_VOLUME_CELL Links
#define CLPV_VOLUME_EACH CLPV_EACH_LINK
#define CLPV_VOLUME_COUNT CLPV_LINKS
#include "volume/instance.h"
