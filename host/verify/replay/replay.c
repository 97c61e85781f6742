/* SPDX-License-Identifier: MIT
 * Replays a capsule of clpv: builds programs, launches kernels and compares their output with that expected. OpenCL 1.2.
 *
 *   replay [FOLDER [DEVICE [OPTIONS]]]
 *
 * FOLDER: the capsule, by default the current folder. DEVICE: a part of "PLATFORM: DEVICE"; by default the first device.
 * OPTIONS: added to the build options. REPLAY_SECONDS: in place of 60.
 * Prints "ok", "wrong" with the first wrong place, "failed" or "unsupported". Exit code: 0 ok, 1 wrong or failed, 77 unsupported.
 * The comment at the top of capsule.txt explains its commands. */
#define _POSIX_C_SOURCE 200112L
#define CL_TARGET_OPENCL_VERSION 120
#include <CL/cl.h>
#include <math.h>
#include <signal.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>
enum { SECONDS = 60, MOST = 4096, UNSUPPORTED = 77 };
static struct { cl_mem handle; size_t bytes, extent[3]; } memories[MOST]; /* extent: of an image */
static cl_program programs[MOST];
static cl_device_id device;
static cl_context context;
static cl_command_queue queue;
static int line, launches, compared;

static void end(int code, const char *format, ...) {
  va_list values;
  printf("%s: capsule.txt:%d: ", code == UNSUPPORTED ? "unsupported" : "failed", line);
  va_start(values, format);
  vprintf(format, values);
  va_end(values);
  puts("");
  fflush(stdout);
  _exit(code); /* a driver's threads may hang */
}

static void on_signal(int number) {
  char text[] = "failed: ended by signal 00 (14: did not end within a minute)\n";
  text[24] = (char)('0' + number / 10), text[25] = (char)('0' + number % 10);
  _exit(write(1, text, sizeof text - 1) != 0);
}

/* Ends after an error of OpenCL; some mean that the device lacks what the capsule needs. */
static void check(cl_int error, const char *what) {
  const int lacks = error == CL_INVALID_BUFFER_SIZE || error == CL_INVALID_WORK_GROUP_SIZE || error == CL_INVALID_WORK_ITEM_SIZE;
  if (error != CL_SUCCESS) end(lacks || !strcmp(what, "clCreateImage") ? UNSUPPORTED : 1, "%s: error %d", what, error);
}

static char *word(const char *wanted) { /* the next of the line */
  char *found = strtok(NULL, " ");
  if (!found) end(1, "found the end of the line, allowed: %s", wanted);
  return found;
}

static size_t number(const char *text, const char *wanted, size_t limit) {
  char *rest;
  const unsigned long long value = strtoull(text, &rest, 10);
  if (*text < '0' || *text > '9' || *rest || value > limit) end(1, "found '%.40s', allowed: %s, at most %zu", text, wanted, limit);
  return (size_t)value;
}
static size_t next(const char *wanted, size_t limit) { return number(word(wanted), wanted, limit); }

static size_t made(const char *text) { /* a memory of an earlier line */
  const size_t at = number(text, "a memory", MOST - 1);
  if (!memories[at].handle) end(1, "found memory %zu, allowed: one of an earlier line", at);
  return at;
}

/* The bytes of a file; zeros follow, at least one, up to `most`. File -: none. */
static char *contents(const char *name, size_t most, size_t *bytes) {
  FILE *file = strcmp(name, "-") ? fopen(name, "rb") : NULL;
  const long size = !strcmp(name, "-") ? 0 : file && !fseek(file, 0, SEEK_END) ? ftell(file) : -1;
  char *found = calloc(most + 1, 1);
  if (!found || size < 0 || (size_t)size > most) end(1, "%s: found %ld bytes (-1: no file), allowed: at most %zu", name, size, most);
  if (file && (fseek(file, 0, SEEK_SET) || fread(found, 1, (size_t)size, file) != (size_t)size || fclose(file)))
    end(1, "%s: cannot be read", name);
  *bytes = (size_t)size;
  return found;
}

static void choose_device(const char *text) {
  cl_platform_id platforms[16];
  cl_device_id devices[16];
  cl_uint count = 0, found = 0;
  char name[2048];
  clGetPlatformIDs(16, platforms, &count);
  for (cl_uint p = 0; p < count && p < 16; ++p, found = 0) {
    clGetDeviceIDs(platforms[p], CL_DEVICE_TYPE_ALL, 16, devices, &found);
    for (cl_uint d = 0; d < found && d < 16; ++d) {
      memset(name, 0, sizeof name);
      clGetPlatformInfo(platforms[p], CL_PLATFORM_NAME, 1000, name, NULL);
      strcat(name, ": ");
      clGetDeviceInfo(devices[d], CL_DEVICE_NAME, 1000, name + strlen(name), NULL);
      device = devices[d];
      if (strstr(name, text) && puts(name) >= 0 && fflush(stdout) == 0) return;
    }
  }
  end(UNSUPPORTED, "no device with '%s' in its name", text);
}

static void make(const char *kind) { /* buffer, image1d (of a buffer) or image3d */
  const size_t at = next("a memory", MOST - 1);
  const int flat = kind[5] == '1';
  size_t *extent = memories[at].extent;
  cl_image_format format;
  cl_image_desc shape = {0};
  char extensions[16384] = "";
  cl_int error;
  if (*kind == 'b') {
    memories[at].bytes = next("bytes", (size_t)1 << 30);
    memories[at].handle = clCreateBuffer(context, CL_MEM_READ_WRITE, memories[at].bytes, NULL, &error);
  } else {
    clGetDeviceInfo(device, CL_DEVICE_EXTENSIONS, sizeof extensions - 1, extensions, NULL);
    if (!flat && !strstr(extensions, "cl_khr_3d_image_writes")) end(UNSUPPORTED, "the device lacks cl_khr_3d_image_writes");
    format.image_channel_order = (cl_channel_order)next("a channel order", 65535);
    format.image_channel_data_type = (cl_channel_type)next("a channel type", 65535);
    shape.image_type = flat ? CL_MEM_OBJECT_IMAGE1D_BUFFER : CL_MEM_OBJECT_IMAGE3D;
    shape.image_width = extent[0] = next("a width", 65536);
    shape.image_height = extent[1] = flat ? 1 : next("a height", 65536);
    shape.image_depth = extent[2] = flat ? 1 : next("a depth", 65536);
    if (flat) shape.buffer = memories[made(word("a buffer"))].handle;
    memories[at].bytes = flat ? 0 : extent[0] * extent[1] * extent[2] * next("bytes of a texel", 64);
    memories[at].handle = clCreateImage(context, CL_MEM_READ_WRITE, &format, &shape, NULL, &error);
  }
  check(error, *kind == 'b' ? "clCreateBuffer" : "clCreateImage");
}

static void transfer(size_t at, void *bytes, int reads) { /* of a whole buffer or image */
  const size_t origin[3] = {0, 0, 0}, *extent = memories[at].extent, size = memories[at].bytes;
  cl_mem m = memories[at].handle;
  check(extent[0] > 0 ? reads ? clEnqueueReadImage(queue, m, CL_TRUE, origin, extent, 0, 0, bytes, 0, NULL, NULL)
                              : clEnqueueWriteImage(queue, m, CL_TRUE, origin, extent, 0, 0, bytes, 0, NULL, NULL)
        : reads       ? clEnqueueReadBuffer(queue, m, CL_TRUE, 0, size, bytes, 0, NULL, NULL)
                      : clEnqueueWriteBuffer(queue, m, CL_TRUE, 0, size, bytes, 0, NULL, NULL), reads ? "reading" : "writing");
}

static void write_memory(void) {
  const size_t at = made(word("a memory"));
  size_t size;
  transfer(at, contents(word("a file"), memories[at].bytes, &size), 0);
}

static void build(const char *more) {
  const size_t at = next("a program", MOST - 1);
  size_t size;
  cl_int error;
  char options[4096] = "", log[4000] = "", *text = contents(word("a file"), (size_t)1 << 24, &size), *option;
  while ((option = strtok(NULL, " ")) != NULL && strlen(options) + strlen(option) + strlen(more) < sizeof options - 3)
    strcat(strcat(options, option), " ");
  strncat(options, more, 2000);
  programs[at] = clCreateProgramWithSource(context, 1, (const char **)&text, NULL, &error);
  check(error, "clCreateProgramWithSource");
  error = clBuildProgram(programs[at], 1, &device, options, NULL, NULL);
  if (error != CL_SUCCESS) clGetProgramBuildInfo(programs[at], device, CL_PROGRAM_BUILD_LOG, sizeof log - 1, log, NULL);
  if (error != CL_SUCCESS) end(1, "clBuildProgram with '%s': error %d\n%s", options, error, log);
}

static void set_argument(cl_kernel kernel, cl_uint position, const char *text) {
  unsigned char value[1024];
  size_t bytes = 0;
  unsigned byte;
  const cl_mem *memory = *text == 'm' ? &memories[made(text + 1)].handle : NULL;
  while (!memory && bytes < sizeof value && sscanf(text + 1 + 2 * bytes, "%2x", &byte) == 1) value[bytes++] = (unsigned char)byte;
  if (!memory && (*text != 'v' || strlen(text) != 2 * bytes + 1)) end(1, "found '%.40s', allowed: mMEMORY or vBYTES", text);
  check(clSetKernelArg(kernel, position, memory ? sizeof *memory : bytes, memory ? (const void *)memory : value), "clSetKernelArg");
}

static void launch(void) {
  const size_t at = next("a program", MOST - 1);
  size_t sizes[6];
  const char *text;
  cl_int error;
  if (!programs[at]) end(1, "found program %zu, allowed: one of an earlier line", at);
  cl_kernel kernel = clCreateKernel(programs[at], word("a kernel"), &error);
  check(error, "clCreateKernel");
  const size_t dimensions = next("dimensions", 3);
  for (size_t i = 0; i < 2 * dimensions; ++i) sizes[i] = next("a size", (size_t)1 << 31);
  for (cl_uint i = 0; (text = strtok(NULL, " ")) != NULL; ++i) set_argument(kernel, i, text);
  check(clEnqueueNDRangeKernel(queue, kernel, (cl_uint)dimensions, NULL, sizes, sizes + dimensions, 0, NULL, NULL), "launching");
  check(clFinish(queue), "clFinish");
  ++launches;
}

static double value_of(const unsigned char *bytes, char kind, size_t i) {
  if (kind == 'b') return bytes[i];
  if (kind == 'h') {
    const unsigned h = bytes[2 * i] | (unsigned)bytes[2 * i + 1] << 8, exponent = h >> 10 & 31, low = h & 1023;
    const double size = ldexp(exponent ? low + 1024 : low, (exponent ? (int)exponent : 1) - 25);
    return exponent == 31 ? NAN : h >> 15 ? -size : size;
  }
  return kind == 'u' ? (double)((const cl_uint *)(const void *)bytes)[i] : (double)((const cl_float *)(const void *)bytes)[i];
}

static int expect(void) {
  const size_t at = made(word("a memory"));
  const char *kind = word("a kind of number"), *name = word("a file");
  const size_t bits = !strcmp(kind, "bits") ? 8 : !strcmp(kind, "half") ? 16 : 32;
  size_t size, wrong = 0, first = 0;
  if (bits == 32 && strcmp(kind, "float") && strcmp(kind, "uint")) end(1, "found '%.40s', allowed: float, half, uint or bits", kind);
  float *ranges = (float *)(void *)contents(name, memories[at].bytes * 64 / bits, &size);
  unsigned char *bytes = calloc(memories[at].bytes + 1, 1);
  if (!bytes || size % 8) end(1, "%s: found %zu bytes, allowed: pairs of floats", name, size);
  transfer(at, bytes, 1);
  for (size_t i = 0; i < size / 8; ++i) {
    const double value = value_of(bytes, kind[0], i), low = ranges[2 * i], high = ranges[2 * i + 1];
    const int fits = bits == 8 ? !(((int)low & ~(int)value) | ((int)value & ~(int)high)) : value >= low && value <= high;
    if (!(isinf(low) && isinf(high)) && !fits && wrong++ == 0) first = i;
  }
  if (wrong > 0)
    printf("wrong: memory %zu, element %zu: %.9g, expected %.9g, tolerance %.3g; %zu of %zu elements are wrong\n", at, first,
           value_of(bytes, kind[0], first), (ranges[2 * first] + ranges[2 * first + 1]) / 2.0,
           (ranges[2 * first + 1] - ranges[2 * first]) / 2.0, wrong, size / 8);
  compared += (int)(size / 8);
  return wrong > 0;
}

int main(int count, char **words) {
  const int signals[] = {SIGALRM, SIGSEGV, SIGABRT, SIGBUS, SIGFPE, SIGILL};
  int wrong = 0;
  if (count > 1 && chdir(words[1]) != 0) end(1, "%s: no such folder", words[1]);
  for (int i = 0; i < 6; ++i) signal(signals[i], on_signal);
  alarm(getenv("REPLAY_SECONDS") ? (unsigned)atoi(getenv("REPLAY_SECONDS")) : SECONDS);
  size_t size;
  char *rest = contents("capsule.txt", (size_t)1 << 22, &size);
  choose_device(count > 2 ? words[2] : "");
  if ((context = clCreateContext(NULL, 1, &device, NULL, NULL, NULL)) == NULL) end(1, "clCreateContext");
  if ((queue = clCreateCommandQueue(context, device, 0, NULL)) == NULL) end(1, "clCreateCommandQueue");
  for (line = 1; rest; ++line) {
    char *start = rest;
    if ((rest = strchr(start, '\n')) != NULL) *rest++ = 0;
    const char *command = strtok(start, " ");
    if (!command || *command == '#') continue;
    if (!strcmp(command, "buffer") || !strcmp(command, "image3d") || !strcmp(command, "image1d")) make(command);
    else if (!strcmp(command, "write")) write_memory();
    else if (!strcmp(command, "program")) build(count > 3 ? words[3] : "");
    else if (!strcmp(command, "launch")) launch();
    else if (!strcmp(command, "expect")) wrong |= expect();
    else end(1, "found '%.40s', allowed: buffer, image3d, image1d, write, program, launch, expect", command);
  }
  if (!wrong) printf("ok: %d launches, %d numbers compared\n", launches, compared);
  fflush(stdout);
  _exit(wrong);
}
