// SPDX-License-Identifier: MIT
// Renders scenes with cascaded light propagation volumes:
//
//   const clpv::Scene scene("cornell.json");
//   clpv::Renderer renderer(scene, clpv::Options().set("basis", "srbf8v2"));
//   const clpv::Image image = renderer.render();
//   clpv::save_image("cornell.png", image);
#pragma once

#include <array>
#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "clpv/device.hpp"
#include "clpv/error.hpp"
#include "clpv/image.hpp"
#include "clpv/options.hpp"
#include "clpv/scene.hpp"
#include "clpv/time_record.hpp"

namespace clpv {

namespace opencl {  // clpv/opencl.hpp
struct Queue;
struct Frame;
struct Volumes;
struct GBuffer;
class Event;
}  // namespace opencl

/// Quantity that an image shows: radiance [W/m^2/sr] (full = direct + indirect), irradiance of
/// indirect light [W/m^2], albedo, unit normal, or depth [m]. Lux and candela of a scene count 1:1
/// as W/m^2 and W/sr. medium: radiance that the scene's medium scatters towards the camera, which
/// full includes. cells: the view irradiance with a small sphere in the cells of the finest
/// cascade. Each point of a sphere shows the irradiance on a surface with its normal at the cell's
/// centre; pathtrace() has no such view.
enum class View { full, direct, indirect, irradiance, albedo, normal, depth, medium, cells };

/// Width and height of an image, 1 to 16384; none: options width and height.
using ImageSize = std::optional<std::array<int, 2>>;

/// Cost of the last frame.
struct Stats {
  /// "frame": wall time of render(), the read-back of the image included; "host": the part of
  /// "frame" in which the host enqueues commands, waits excluded. Then the stages that ran, on the
  /// device, by cascade and light; a stage whose result was cached, or which the options do not
  /// need, is missing.
  std::vector<TimeRecord> times;
  unsigned launches = 0;  ///< kernels, fills and copies of the device
  unsigned waits = 0;     ///< times that the host waited for the device, the read-back included
  double build_ms = 0;    ///< time so far for compiling programs or loading them
  std::size_t device_bytes = 0;       ///< device memory in use
  std::size_t peak_device_bytes = 0;  ///< maximum so far
};

/// Light of one cascade after propagation, on the host. A cell is a cube; its light is radiant
/// intensity
///   I(w) = sum_i c_i b_i(w) [W/sr],   b_i: functions of `basis`, w: direction in which light
///                                     travels
/// After a sweep (option transport) the basis is `sh3` whatever light was injected in, and the
/// radiance about the cell's centre is L(w) = I(w) / cell^2 [W/m^2/sr].
struct LightVolume {
  Vec3 origin{};              ///< minimum corner [m]
  double cell = 0;            ///< edge of a cell [m]
  int n = 0;                  ///< cells along each axis
  int coefficients = 0;       ///< N
  std::string basis;          ///< name of the basis of the coefficients
  std::vector<float> values;  ///< [channel][i][z][y][x]: red, green, blue; N coefficients; cells
  /// [i][z][y][x]: radiance of the white furnace after a sweep, which irradiance() and radiance()
  /// divide by; empty after other transports
  std::vector<float> furnace;
};

/// Surfaces that the caller's pixels show: a G-buffer, one value per pixel, row 0 first. It has
/// positions, from any kind of camera, or depths of a Camera. A pixel has no surface, and no light,
/// if its normal is 0, its depth is not positive, or a number of it is not finite.
struct GBuffer {
  int width = 0, height = 0;                             ///< 1 to 16384
  std::span<const std::array<float, 3>> normals{};       ///< any length, on the side that is seen
  std::span<const std::array<float, 3>> positions = {};  ///< [m]
  std::span<const float> depths =
      {};  ///< [m] along the camera's viewing direction, row 0 at the top
};

/// Renders frames of one scene with one set of options. Owns an OpenCL context, compiled programs
/// and all memory of a frame, and shares the scene. Results that do not change are cached from
/// frame to frame. Thread-safe: calls from several threads run one after the other; for parallel
/// frames use one Renderer per thread.
class Renderer {
 public:
  /// `device`: an index, "PLATFORM:DEVICE", or a part of the name; empty: CLPV_DEVICE, else the
  /// first device that clpv can use. Loads compiled programs from the user's cache. Throws Error:
  /// usage (options), device (no device matches), run_time (out of memory; the message says what
  /// would fit).
  explicit Renderer(const Scene& scene, const Options& options = {},
                    const std::string& device = {});
  /// The same in a context and queue of the caller. Throws Error: usage (neither context nor queue;
  /// a queue of another context, an out-of-order queue, several devices without a queue), device (a
  /// device that lacks a capability).
  Renderer(const Scene& scene, const Options& options, const opencl::Queue& queue);
  ~Renderer();  ///< waits for its commands; stores compiled programs in the user's cache
  /// Calls of a Renderer that was moved from throw Error(usage).
  Renderer(Renderer&&) noexcept;
  Renderer& operator=(Renderer&&) noexcept;

  /// Renders one frame at time `seconds` [s] through `camera`: the name of one of the scene's
  /// cameras, or any Camera. Cascades surround its eye; for a model without a scene file their size
  /// is that for the scene's cameras unless option cascade-size is set. Returns a linear image of
  /// `size` with channels R, G, B, A, all options in its metadata. A frame does not depend on
  /// earlier frames; a change of `size` allocates the images again. Throws Error: usage (no such
  /// camera, a bad one, seconds or size out of range), bad_input (animation leads out of bounds),
  /// run_time (memory).
  Image render(View view = View::full, const CameraChoice& camera = {}, double seconds = 0,
               const ImageSize& size = {});

  /// Another view of the last frame, without rendering it again. After light() or update(),
  /// View::cells first lights the rendered frame's cascades again, and at the end those of that
  /// call. Throws Error(usage) before the first frame, and for View::cells in this case if the
  /// scene has changed since the render.
  Image show(View view);

  /// Returns the irradiance of indirect light [W/m^2], red, green and blue, on each pixel of
  /// `surfaces` at time `seconds` [s], with the near field, as View::irradiance has it: a frame for
  /// a G-buffer of another renderer. Leaves the last frame's images as they are, for show().
  /// Cascades surround the camera's eye; GBuffer::depths are measured in that camera's view of
  /// width x height square pixels. The near field interpolates between a pixel and its neighbours
  /// in the image that lie on its surface (docs/api.md). Throws Error: usage (sizes, camera,
  /// seconds; option blockers seen), run_time (memory).
  std::vector<std::array<float, 3>> light(const GBuffer& surfaces, const CameraChoice& camera,
                                          double seconds = 0);
  /// The same for positions, with cascades about `eye` [m] and all lights of the scene.
  std::vector<std::array<float, 3>> light(const GBuffer& surfaces, const Vec3& eye,
                                          double seconds = 0);

  /// Lights cascades about `eye` [m] with all lights of the scene at time `seconds` [s], without a
  /// frame: for irradiance(), radiance(), volumes() and device_volumes(). Throws as light().
  void update(const Vec3& eye, double seconds = 0);

  /// Frees the device's memory. The next call that lights or renders allocates it again; compiled
  /// programs stay.
  void release();

  /// Returns the irradiance of indirect light [W/m^2], red, green and blue, on a surface at
  /// `position` [m] with `normal` (of any length), visible or not. Uses the volumes of the last
  /// frame, light() or update(), without option near; 0 outside of its cascades. Computed on the
  /// device. Throws Error(usage) before the first frame, and for a position that is not finite or a
  /// normal of length 0.
  std::array<double, 3> irradiance(const Vec3& position, const Vec3& normal);

  /// The same for many points, with a normal for each or one for all. Also throws Error(usage) if
  /// `normals` has neither one element nor one per position. An error for a bad vector names its
  /// index.
  std::vector<std::array<float, 3>> irradiance(std::span<const std::array<float, 3>> positions,
                                               std::span<const std::array<float, 3>> normals);

  /// Returns the radiance of indirect light [W/m^2/sr], red, green and blue, at each of `positions`
  /// [m], of light that travels along directions[i], or along the only direction: what an eye at
  /// the position sees when it looks against that direction. Interpolates the volumes of the last
  /// frame, without option near; 0 outside of its cascades. Negative where nine harmonics
  /// undershoot. Computed on the device. Throws Error(usage) before the first frame, without
  /// transport sweep, for layout image with gather all, and for vectors as irradiance() does.
  std::vector<std::array<float, 3>> radiance(std::span<const std::array<float, 3>> positions,
                                             std::span<const std::array<float, 3>> directions);

  /// Reads back the volumes of the last render(), light() or update(), finest cascade first. Throws
  /// Error(usage) before the first frame.
  std::vector<LightVolume> volumes();

  /// Like render(), but enqueues the frame and returns its device memory before the device has
  /// finished it (docs/api.md lists the waits that remain). Throws Error(usage) also for
  /// View::cells.
  opencl::Frame enqueue(View view = View::full, const CameraChoice& camera = {}, double seconds = 0,
                        const ImageSize& size = {});
  /// Like light(), from and to device memory. Throws Error(usage) also for an object that is no
  /// buffer of the renderer's context or is too small.
  opencl::Event enqueue_light(const opencl::GBuffer& surfaces, const CameraChoice& camera,
                              double seconds = 0);
  opencl::Event enqueue_light(const opencl::GBuffer& surfaces, const Vec3& eye, double seconds = 0);

  /// Light of the last frame or light() for a caller's kernel. Throws Error(usage) as radiance().
  opencl::Volumes device_volumes();
  /// OpenCL C 1.2 for the start of a caller's program: clpv_irradiance(CLPV_PASS_RADIANCE,
  /// position, normal) and clpv_radiance(CLPV_PASS_RADIANCE, position, direction), for kernels with
  /// the parameters CLPV_RADIANCE (kernels/gather/lookup.h). One text for all frames of a renderer.
  /// Throws Error(usage) for options as radiance().
  std::string lookup_source() const;

  /// Size, basis, transport and device in one line.
  std::string description() const;

  /// Returns the cost of the last frame; all 0 before the first.
  Stats stats() const;

 private:
  struct State;
  State& state() const;  ///< throws Error(usage) after a move
  std::unique_ptr<State> state_;
};

}  // namespace clpv
