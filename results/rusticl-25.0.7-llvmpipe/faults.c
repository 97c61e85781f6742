// A fault of rusticl (Mesa 25.0.7, llvmpipe, Debian 13): cc faults.c -lOpenCL && ./a.out prints 4 8 12 on PoCL 3.1, nan nan nan there.
// Needed for it: `add` returns the struct of `vec`, and a kernel before `k` calls it. always_inline does not help; an
// initialiser, return (Vec){...}, in place of vec(...) does.
#define CL_TARGET_OPENCL_VERSION 120
#include <CL/cl.h>
#include <stdio.h>
int main(void) {
  cl_platform_id platform; cl_device_id d; cl_int code; float out[3] = {0};
  clGetPlatformIDs(1, &platform, 0), clGetDeviceIDs(platform, CL_DEVICE_TYPE_ALL, 1, &d, 0);
  cl_context context = clCreateContext(0, 1, &d, 0, 0, 0);
  cl_command_queue queue = clCreateCommandQueue(context, d, 0, 0);
  const char* text =
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
      "}\n";
  cl_program program = clCreateProgramWithSource(context, 1, &text, 0, 0);
  clBuildProgram(program, 1, &d, "-cl-std=CL1.2", 0, 0);
  cl_mem buffer = clCreateBuffer(context, CL_MEM_COPY_HOST_PTR, sizeof out, out, 0);
  cl_kernel kernel = clCreateKernel(program, "k", &code);
  clSetKernelArg(kernel, 0, sizeof buffer, &buffer);
  clEnqueueNDRangeKernel(queue, kernel, 1, 0, &(size_t){1}, 0, 0, 0, 0);
  clEnqueueReadBuffer(queue, buffer, CL_TRUE, 0, sizeof out, out, 0, 0, 0);
  printf("%g %g %g\n", out[0], out[1], out[2]);
}
