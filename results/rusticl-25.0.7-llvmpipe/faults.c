// Faults of rusticl on llvmpipe. cc faults.c -lOpenCL && ./a.out prints 4 8 12 twice on PoCL 3.1, and with an argument 8 0 0 after it.
// Mesa 25.0.7 (Debian 13) prints nan nan nan, 0 0 12, 8 0 0; 26.2.6 (unstable) is right, but ends by signal 11 with an argument.
// First: `add` returns the struct of `vec`, and a kernel before `k` calls it. always_inline does not help; an initialiser, return
//   (Vec){...}, in place of vec(...) does.
// Second: a loop passes a struct to an always_inline function, and all but the last are lost. Without always_inline, or without the
//   loop, it is right.
// Third: an inner loop begins at i + 1 where i counts down. From 0, with a condition, it is right.
#define CL_TARGET_OPENCL_VERSION 120
#include <CL/cl.h>
#include <stdio.h>
int main(int argc, char** argv) {
  cl_platform_id platform; cl_device_id d; cl_int code;
  clGetPlatformIDs(1, &platform, 0), clGetDeviceIDs(platform, CL_DEVICE_TYPE_ALL, 1, &d, 0);
  cl_context context = clCreateContext(0, 1, &d, 0, 0, 0);
  cl_command_queue queue = clCreateCommandQueue(context, d, 0, 0);
  const char* texts[] = {
      "typedef struct { float x, y, z; } Vec;\n"
      "static inline Vec vec(float x, float y, float z) { const Vec v = {x, y, z}; return v; }\n"
      "static inline Vec add(const Vec a, const Vec b) { return vec(a.x + b.x, a.y + b.y, a.z + b.z); }\n"
      "kernel void first(global float* out) {\n"
      "  Vec v = vec(out[0], out[1], out[2]);\n"
      "  v = add(v, v);\n"
      "  out[0] = v.x + v.y + v.z;\n"
      "}\n"
      "kernel void k(global float* out) {\n"
      "  Vec sum = vec(0, 0, 0);\n"
      "  for (int i = 0; i < 4; ++i) sum = add(sum, vec(1, 2, 3));\n"
      "  out[0] = sum.x; out[1] = sum.y; out[2] = sum.z;\n"
      "}\n",
      "typedef struct { float x[1]; } One;\n"
      "static inline __attribute__((always_inline)) void store(global float* to, const One a) {\n"
      "  for (int i = 0; i < 1; ++i) to[i] = a.x[i];\n"
      "}\n"
      "kernel void k(global float* out) {\n"
      "  for (int i = 0; i < 3; ++i) {\n"
      "    One a;\n"
      "    a.x[0] = 4 * (i + 1);\n"
      "    store(out + i, a);\n"
      "  }\n"
      "}\n",
      "constant float m[4][4] = {{4, 0, 0, 0}, {4, 4, 0, 0}, {4, 0, 4, 0}, {0, 0, 0, 4}};\n"
      "kernel void k(global float* out) {\n"
      "  float r[4] = {out[0], out[1], out[2], 0};\n"
      "  for (int i = 3; i >= 0; --i)\n"
      "    for (int j = i + 1; j < 4; ++j) r[i] += m[j][i];\n"
      "  out[0] = r[0];\n"
      "}\n"};
  for (int i = 0; i < (argc > 1 ? 3 : 2); ++i) {
    float out[3] = {0};
    cl_program program = clCreateProgramWithSource(context, 1, texts + i, 0, 0);
    clBuildProgram(program, 1, &d, "-cl-std=CL1.2", 0, 0);
    cl_mem buffer = clCreateBuffer(context, CL_MEM_COPY_HOST_PTR, sizeof out, out, 0);
    cl_kernel kernel = clCreateKernel(program, "k", &code);
    clSetKernelArg(kernel, 0, sizeof buffer, &buffer);
    clEnqueueNDRangeKernel(queue, kernel, 1, 0, &(size_t){1}, 0, 0, 0, 0);
    clEnqueueReadBuffer(queue, buffer, CL_TRUE, 0, sizeof out, out, 0, 0, 0);
    printf("%g %g %g\n", out[0], out[1], out[2]);
  }
}
