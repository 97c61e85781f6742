// SPDX-License-Identifier: MIT
// Transmittance volumes: transmittance in [0, 1] of each link into every light cell. CLPV_GRID:
// cells along each axis.
#include "volume/links.h"
#define CLPV_VOLUME transmittance
#define CLPV_VOLUME_N CLPV_GRID
#define CLPV_VOLUME_CELL Links
#define CLPV_VOLUME_COUNT CLPV_LINKS
#include "volume/instance.h"
