// SPDX-License-Identifier: MIT
// Kernels with known faults: if Oclgrind is silent about these, its silence about the others means nothing.

// Every work-item reads and writes the same word.
__kernel void racy(__global int* sum) { sum[0] += (int)get_global_id(0); }

// A branch on memory that nothing has written.
__kernel void uninitialised(__global const int* in, __global int* out) {
  const size_t i = get_global_id(0);
  if (in[i] > 3) out[i] = 1;
}

// No fault: a report here is a false alarm.
__kernel void sound(__global int* out) { out[get_global_id(0)] = (int)get_global_id(0); }
