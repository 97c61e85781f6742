// SPDX-License-Identifier: MIT
// Scenes lit by cascaded light propagation volumes, from a program of your own:
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

/// What an image shows. All but albedo, normal, depth: radiance [W/m^2/sr], or irradiance [W/m^2]; photometric input is
/// carried 1:1. full = direct + indirect.
enum class View { full, direct, indirect, irradiance, albedo, normal, depth };

/// Holds a device, its programs and all memory a frame needs; renders again and again. One a thread.
class Renderer {
 public:
  /// `device`: an index, "PLATFORM:DEVICE", or a part of its name; empty: CLPV_DEVICE, else the first that clpv can use.
  /// Programs compiled before are taken from the user's cache. Throws Error: usage (options), device (none fits),
  /// run_time (memory, and what would fit).
  explicit Renderer(const SceneFile& scene, const Options& options = {}, const std::string& device = {});
  ~Renderer();  ///< keeps compiled programs in the user's cache
  Renderer(Renderer&&) noexcept;
  Renderer& operator=(Renderer&&) noexcept;

  /// One frame through the camera of that name (empty: the scene's first) at an instant, of a scene that moves. Linear,
  /// channels R, G, B, A, row 0 on top; metadata holds every option. Any instant's frame is the same whatever came before it.
  /// Throws Error: usage (a camera that is not there, seconds out of range), bad_input (what moves leads out of bounds).
  Image render(View view = View::full, const std::string& camera = {}, double seconds = 0);

  /// Irradiance of indirect light [W/m^2] of red, green, blue on a surface at `position` [m] with `normal` (of any length),
  /// whether the camera sees it or not: by the light of the last frame; 0 outside its cascades, which stand round its camera.
  /// The first point after a frame waits for the volumes to be read back. Throws Error(usage) before the first frame, and for
  /// what is no position or direction.
  std::array<double, 3> irradiance(const std::array<double, 3>& position,
                                   const std::array<double, 3>& normal);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace clpv
