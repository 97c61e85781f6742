// Three faults of PoCL 7.1 (Debian, LLVM 21): cc faults.c -lOpenCL && ./a.out prints -11, 0, -59 and 153; PoCL 3.1 and 6.0: 0, 0, 0
// and 150. The third: an inner loop that is not unrolled stores an array in an outer loop that is. The second iteration's stores come
// too early, as if LLVM's unroll-and-jam had merged the inner loops. With #pragma unroll there too, or without any, it is right.
#define CL_TARGET_OPENCL_VERSION 120
#include <CL/cl.h>
#include <stdio.h>
int main(void) {
  cl_platform_id platform; cl_device_id d; cl_int code;
  clGetPlatformIDs(1, &platform, 0), clGetDeviceIDs(platform, CL_DEVICE_TYPE_ALL, 1, &d, 0);
  cl_context context = clCreateContext(0, 1, &d, 0, 0, 0);
  const char* text = "kernel void k(read_only image2d_t i, global float4* o) { *o = read_imagef(i, (int2)(0)); }";
  cl_program program = clCreateProgramWithSource(context, 1, &text, 0, 0);
  printf("read_imagef with -cl-std=CL1.2: %d\n", clBuildProgram(program, 1, &d, "-cl-std=CL1.2", 0, 0));
  printf("read_imagef without: %d\n", clBuildProgram(program, 1, &d, "", 0, 0));
  cl_image_desc image = {.image_type = CL_MEM_OBJECT_IMAGE1D_BUFFER, .image_width = 16,
                         .buffer = clCreateBuffer(context, CL_MEM_READ_WRITE, 64, 0, 0)};
  clCreateImage(context, CL_MEM_READ_ONLY, &(cl_image_format){CL_R, CL_FLOAT}, &image, 0, &code);
  printf("1-D image of a buffer: %d\n", code);
  text =
      "kernel void k(global const float* from, global float* to) {\n"
      "  float rows[4], sum = 0;\n"
      "#pragma unroll\n"
      "  for (int c = 0; c < 2; ++c) {\n"
      "    for (int i = 0; i < 4; ++i) rows[i] = from[c + i];\n"
      "#pragma unroll\n"
      "    for (int i = 0; i < 4; ++i) sum += rows[i] * (1 + 9 * c);\n"
      "  }\n"
      "  *to = sum;\n"
      "}\n";
  float numbers[] = {1, 2, 3, 4, 5}, sum = 0;
  program = clCreateProgramWithSource(context, 1, &text, 0, 0);
  clBuildProgram(program, 1, &d, "", 0, 0);
  cl_kernel kernel = clCreateKernel(program, "k", &code);
  cl_mem from = clCreateBuffer(context, CL_MEM_COPY_HOST_PTR, sizeof numbers, numbers, 0),
         to = clCreateBuffer(context, CL_MEM_READ_WRITE, sizeof sum, 0, 0);
  clSetKernelArg(kernel, 0, sizeof from, &from), clSetKernelArg(kernel, 1, sizeof to, &to);
  cl_command_queue queue = clCreateCommandQueue(context, d, 0, 0);
  clEnqueueNDRangeKernel(queue, kernel, 1, 0, &(size_t){1}, 0, 0, 0, 0);
  clEnqueueReadBuffer(queue, to, CL_TRUE, 0, sizeof sum, &sum, 0, 0, 0);
  printf("a loop in an unrolled loop: %g\n", sum);
}
