// SPDX-License-Identifier: MIT
// Asking for memory some time before it is read, where what will be read cannot be guessed from what was.
//
// OpenCL's own prefetch() does nothing on PoCL 3.1. Clang's takes pointers of no kind but a work-item's own, which on a CPU are
// addresses of the same memory as all others; compilers to SPIR-V reject it. So it is for what is compiled for a CPU outright.
#ifndef CLPV_PREFETCH_H
#define CLPV_PREFETCH_H

#define CLPV_LINE 64  // bytes of a cache line, as most CPUs have them

#if (defined(__x86_64__) || defined(__aarch64__)) && defined(__has_builtin)
#if __has_builtin(__builtin_prefetch)
#define CLPV_PREFETCH(at) __builtin_prefetch((const void*)(size_t)(at))
#endif
#endif
#ifndef CLPV_PREFETCH
#define CLPV_PREFETCH(at)
#endif

#endif
