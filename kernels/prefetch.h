// SPDX-License-Identifier: MIT
// Prefetches memory that hardware prefetch cannot predict, on CPUs.
//
// OpenCL's prefetch() does nothing on PoCL 3.1. Clang's builtin takes only private pointers, which
// on a CPU address the same memory as global ones; compilers to SPIR-V reject it.
#pragma once

enum { CLPV_LINE = 64 };  // [bytes] cache line of most CPUs

static inline void prefetch_line(__global const void* at) {
#if (defined(__x86_64__) || defined(__aarch64__)) && defined(__has_builtin)
#if __has_builtin(__builtin_prefetch)
  __builtin_prefetch((const void*)(size_t)at);
#endif
#endif
}
