// SPDX-License-Identifier: MIT
// How many times a loop may turn, as host and kernels both see it: Mesa's rusticl (22.3) ends longer ones without a word.
// Loops whose length a scene decides are split by it.
#ifndef CLPV_SHARED_LOOPS_H
#define CLPV_SHARED_LOOPS_H

#define CLPV_LONGEST_LOOP 65535u

#endif
