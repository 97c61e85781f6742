// SPDX-License-Identifier: MIT
// Numbers of the links into W cells. CLPV_LINKS: number of links into a cell.
#pragma once

#include "lanes.h"

typedef struct {
  realW c[CLPV_LINKS];
} Links;
