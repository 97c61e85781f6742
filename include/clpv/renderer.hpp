// SPDX-License-Identifier: MIT
// Scenes lit by cascaded light propagation volumes, from a program of your own:
//
//   const clpv::SceneFile scene("cornell.json");
//   clpv::Renderer renderer(scene, clpv::Options().set("basis", "srbf8v2"));
//   const clpv::Image image = renderer.render();
//   clpv::save_image("cornell.png", image);
#pragma once

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

  /// One frame through the camera of that name; empty: the scene's first. Linear, channels R, G, B, A, row 0 on top;
  /// metadata holds every option. Throws Error(usage) for a camera that is not there.
  Image render(View view = View::full, const std::string& camera = {});

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace clpv
