// SPDX-License-Identifier: MIT
// Asking for memory some time before it is read, where what will be read cannot be guessed from what was.
//
// CLPV_ONE_MEMORY 1: pointers of all kinds are addresses of one memory, as on a CPU. OpenCL's own prefetch() does nothing on
// PoCL 3.1, and clang's takes pointers of no kind but a work-item's own.
#ifndef CLPV_PREFETCH_H
#define CLPV_PREFETCH_H

#define CLPV_LINE 64  // bytes of a cache line, as most CPUs have them

#ifndef CLPV_ONE_MEMORY
#define CLPV_ONE_MEMORY 0
#endif

#if CLPV_ONE_MEMORY && defined(__has_builtin)
#if __has_builtin(__builtin_prefetch)
#define CLPV_PREFETCH(at) __builtin_prefetch((const void*)(size_t)(at))
#endif
#endif
#ifndef CLPV_PREFETCH
#define CLPV_PREFETCH(at)
#endif

#endif
