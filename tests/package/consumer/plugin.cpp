// SPDX-License-Identifier: MIT
// A plugin that renders: its only symbol is its own.
#include <clpv/renderer.hpp>

extern "C" __attribute__((visibility("default"))) int plugin_width(const char* scene) {
  clpv::Renderer renderer{clpv::Scene(scene)};
  return renderer.render(clpv::View::full).width;
}
