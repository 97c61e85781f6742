// SPDX-License-Identifier: MIT
// Maximum number of iterations of a loop, shared by host and kernels: Mesa's rusticl (22.3)
// silently ends longer ones. Loops whose length depends on the scene are split.
#pragma once

#define CLPV_LONGEST_LOOP 65535u
