// SPDX-License-Identifier: MIT
// Measures the limits of a device, for the roofline of `clpv bench`: fused multiply-adds, memory
// bandwidth, launches.
//
//   fma_peak   a = a / 2 + 1, 48 vector FMAs per pass and work-item; out: one float per work-item
//   stream     c = a + pass b, three vectors moved per element (McCalpin's STREAM triad)
//   nothing    an empty kernel
//
// From the host: CLPV_VECTOR, the type of a vector; CLPV_BLOCK, consecutive vectors of a work-item:
// all of its vectors on a CPU, whose cores stream through a part of memory each, or 1 where
// neighbouring work-items should access neighbouring memory.
#ifndef CLPV_VECTOR
#define CLPV_VECTOR float8
#endif
#ifndef CLPV_BLOCK
#define CLPV_BLOCK 1u
#endif
typedef CLPV_VECTOR Vector;

// Independent chains: enough to hide the latency of an FMA, few enough to fit into registers.
enum { CLPV_CHAINS = 12, CLPV_UNROLLED = 4 };

// Every chain converges to 2 from any start, which verifies the result.
__kernel void fma_peak(const uint passes, const float start, __global float* out) {
  const uint item = get_global_id(0);
  Vector a[CLPV_CHAINS];
#pragma unroll
  for (int i = 0; i < CLPV_CHAINS; ++i) a[i] = (Vector)(start + i + item);
  for (uint pass = 0; pass < passes; ++pass) {
#pragma unroll
    for (int i = 0; i < CLPV_UNROLLED * CLPV_CHAINS; ++i)
      a[i % CLPV_CHAINS] = fma(a[i % CLPV_CHAINS], (Vector)(0.5f), (Vector)(1.0f));
  }
  Vector sum = 0.0f;
#pragma unroll
  for (int i = 0; i < CLPV_CHAINS; ++i) sum += a[i];
  // All components count: a compiler for scalars would drop the chains of unused ones.
  float total = 0.0f;
  for (int i = 0; i < (int)(sizeof(Vector) / sizeof(float)); ++i) total += ((const float*)&sum)[i];
  out[item] = total;
}

// `blocks`: blocks of CLPV_BLOCK vectors per work-item.
__kernel void stream(const uint passes, const uint blocks, __global const Vector* a,
                     __global const Vector* b, __global Vector* c) {
  const uint item = get_global_id(0), items = get_global_size(0);
  for (uint pass = 1; pass <= passes; ++pass) {
    const Vector factor = (float)pass;
    for (uint block = 0; block < blocks; ++block) {
      const uint first = (block * items + item) * CLPV_BLOCK;
      for (uint i = first; i < first + CLPV_BLOCK; ++i) c[i] = fma(factor, b[i], a[i]);
    }
  }
}

__kernel void nothing(__global float* out) {
  if (get_global_id(0) == 0) out[0] = 1.0f;
}
