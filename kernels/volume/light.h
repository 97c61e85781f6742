// SPDX-License-Identifier: MIT
// Light volumes: radiant intensity [W/sr] of every light cell, N coefficients per channel.
// CLPV_GRID: cells along each axis.
#include "volume/coefficients.h"
#define CLPV_VOLUME light
#include "volume/instance.h"
