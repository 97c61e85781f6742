// SPDX-License-Identifier: MIT
// Renders scenes with cascaded light propagation volumes:
//
//   const clpv::SceneFile scene("cornell.json");
//   clpv::Renderer renderer(scene, clpv::Options().set("basis", "srbf8v2"));
//   const clpv::Image image = renderer.render();
//   clpv::save_image("cornell.png", image);
#pragma once

#include <array>
#include <memory>
#include <string>

#include "clpv/device.hpp"
#include "clpv/error.hpp"
#include "clpv/image.hpp"
#include "clpv/options.hpp"
#include "clpv/scene.hpp"

namespace clpv {

/// Quantity that an image shows: radiance [W/m^2/sr] (full = direct + indirect), irradiance of indirect light [W/m^2], albedo, unit
/// normal, or depth [m]. Lux and candela of a scene count 1:1 as W/m^2 and W/sr.
enum class View { full, direct, indirect, irradiance, albedo, normal, depth };

/// Renders frames of one scene with one set of options. Owns an OpenCL context, compiled programs and all memory of a frame.
/// Results that do not change are cached from frame to frame. Not thread-safe: use one Renderer per thread.
class Renderer {
 public:
  /// `device`: an index, "PLATFORM:DEVICE", or a part of the name; empty: CLPV_DEVICE, else the first device that clpv can
  /// use. Loads compiled programs from the user's cache. Throws Error: usage (options), device (no device matches),
  /// run_time (out of memory; the message says what would fit).
  explicit Renderer(const SceneFile& scene, const Options& options = {}, const std::string& device = {});
  ~Renderer();  ///< stores compiled programs in the user's cache
  Renderer(Renderer&&) noexcept;
  Renderer& operator=(Renderer&&) noexcept;

  /// Renders one frame at time `seconds` [s] through the camera of that name (empty: the scene's first). Returns a linear image of
  /// --width x --height pixels with channels R, G, B, A, all options in its metadata. A frame does not depend on earlier frames.
  /// Throws Error: usage (no such camera, seconds out of range), bad_input (animation leads out of bounds), run_time (memory).
  Image render(View view = View::full, const std::string& camera = {}, double seconds = 0);

  /// Returns the irradiance of indirect light [W/m^2], red, green and blue, on a surface at `position` [m] with `normal` (of any
  /// length), visible or not. Uses the volumes of the last frame; 0 outside of its cascades. The first call after a frame
  /// reads the volumes back from the device. Throws Error(usage) before the first frame, and for a position that is not
  /// finite or a normal of length 0.
  std::array<double, 3> irradiance(const std::array<double, 3>& position,
                                   const std::array<double, 3>& normal);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace clpv
