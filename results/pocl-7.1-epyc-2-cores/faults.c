// Two faults of PoCL 7.1 (Debian, LLVM 21): cc faults.c -lOpenCL && ./a.out prints -11, 0 and -59; PoCL 3.1 and 6.0: 0, 0 and 0.
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
}
