// SPDX-License-Identifier: MIT
// Light volumes: radiant intensity [W/sr] of every light cell, N coefficients per channel.
// CLPV_GRID: cells along each axis.
#include "volume/coefficients.h"
#define CLPV_VOLUME light
#define CLPV_VOLUME_N CLPV_GRID
#define CLPV_VOLUME_CELL Coefficients
#define CLPV_VOLUME_COUNT CLPV_N
#include "volume/instance.h"
