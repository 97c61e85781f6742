// Computes in double, which no kernel of clpv may: the syntax check must reject it.
__kernel void halve(__global float* a) { a[get_global_id(0)] *= 0.5; }
