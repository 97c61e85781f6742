// SPDX-License-Identifier: MIT
// OpenCL objects: a renderer in a context and queue of the caller, and its results as device memory
// (docs/api.md, 'OpenCL').
#pragma once

#include <CL/cl.h>

#include <utility>

#include "clpv/renderer.hpp"

namespace clpv::opencl {

/// Where a Renderer works. The renderer retains context and queue while it lives. The queue is
/// in-order; it may be shared with the caller's commands, which then run in the order of the calls.
/// Without a queue the renderer makes one for the context's only device. Without a context it is
/// the queue's. Stage times need a queue with profiling; else Stats has zeros.
struct Queue {
  cl_context context = nullptr;
  cl_command_queue queue = nullptr;
};

/// Completion of commands; released with this object.
class Event {
 public:
  explicit Event(cl_event owned = nullptr) : event_(owned) {}
  ~Event() {
    if (event_ != nullptr) clReleaseEvent(event_);
  }
  Event(Event&& other) noexcept : event_(std::exchange(other.event_, nullptr)) {}
  Event& operator=(Event&& other) noexcept {
    std::swap(event_, other.event_);
    return *this;
  }

  cl_event get() const { return event_; }
  /// Waits for the commands. Returns CL_SUCCESS or an OpenCL error code.
  cl_int wait() const { return clWaitForEvents(1, &event_); }

 private:
  cl_event event_;
};

/// Buffers of a frame, of width x height pixels, row 0 at the top. They belong to the renderer:
/// they stay valid until its next call that renders. A caller may retain them (clRetainMemObject)
/// for longer, but later calls overwrite their contents.
struct Frame {
  int width = 0, height = 0;
  /// Float4 R, G, B, A of the view that was asked for, linear; without a sky.
  cl_mem image = nullptr;
  cl_mem irradiance = nullptr;  ///< float4 E of red, green, blue [W/m^2], and 0, of indirect light
  cl_mem depth = nullptr;       ///< float [m] along the viewing direction; 0 without a surface
  /// Float4 x, y, z: unit shading normal; w: the triangle's normal, encoded
  /// (kernels/shared/normal.h); 0 without a surface.
  cl_mem normals = nullptr;
  Event done;  ///< end of the whole frame
};

/// Light of all cascades for a caller's kernel: the arguments CLPV_RADIANCE of
/// Renderer::lookup_source(), in its order. Buffers belong to the renderer like those of Frame.
struct Volumes {
  /// ClpvGrid of each cascade, finest first (clpv/kernels/shared/grid.h): 32 bytes.
  cl_mem grids = nullptr;
  cl_uint cascades = 0;
  cl_float unit = 0;          ///< radiant intensity of a stored 1 [W/sr]
  cl_mem packed = nullptr;    ///< float [cascade][z][y][x][5][2][4]: pair, coefficient of the pair;
                              ///< red, green, blue, and the white furnace
  cl_mem occluded = nullptr;  ///< uchar [cascade][z][y][x][4][4][4], bits of occluded cells; null
                              ///< with gather `all`, whose kernels have no such parameter
};

/// A G-buffer of the caller (clpv::GBuffer) in buffers of the renderer's context. Larger buffers
/// are allowed.
struct GBuffer {
  int width = 0, height = 0;    ///< 1 to 16384
  cl_mem normals = nullptr;     ///< float4 per pixel, of any length, w unused
  cl_mem positions = nullptr;   ///< float4 [m], w unused; or
  cl_mem depths = nullptr;      ///< float [m]
  cl_mem irradiance = nullptr;  ///< receives float4 E of red, green, blue [W/m^2], and 0
};

}  // namespace clpv::opencl
