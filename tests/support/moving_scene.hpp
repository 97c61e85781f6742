// SPDX-License-Identifier: MIT
// A small scene in which everything moves from 0 s to 1 s: an object, a sun, a lamp and the camera.
#pragma once

#include <filesystem>

#include "tests/support/gltf_builder.hpp"

namespace clpv::test {

/// A wall that glides over a floor. Returns the scene file.
inline std::filesystem::path write_moving_scene(const TemporaryFolder& folder) {
  GltfBuilder model;
  const int floor = model.accessor<float>("VEC3", {-2, 0, -2, -2, 0, 2, 2, 0, 2, 2, 0, -2});
  const int wall = model.accessor<float>("VEC3", {0, 0, 0, 0.6f, 0, 0, 0.6f, 1, 0, 0, 1, 0});
  const int corners = model.accessor<std::uint8_t>("SCALAR", {0, 1, 2, 0, 2, 3});
  model.mesh({{"POSITION", floor}}, {{"indices", corners}});
  model.mesh({{"POSITION", wall}}, {{"indices", corners}, {"material", 0}});
  model.document["materials"] = {{{"doubleSided", true}}};
  const json sampler = {{"input", model.accessor<float>("SCALAR", {0, 1})},
                        {"output", model.accessor<float>("VEC3", {-1, 0, 0, 1, 0, 0.5f})}};
  const json channel = {{"sampler", 0}, {"target", {{"node", 1}, {"path", "translation"}}}};
  model.add("animations", {{"samplers", {sampler}}, {"channels", {channel}}});
  model.write(folder);
  return folder.write("moving.json", R"({"model": "model.gltf", "cascades": {"count": 2, "size_metres": 4},
    "cameras": [{"name": "walk", "target": [0, 0.4, 0], "keys": [
      {"time": 0, "eye": [0, 1.5, 3]}, {"time": 1, "eye": [1, 1, 2.5]}]}],
    "lights": [{"name": "sun", "kind": "directional", "illuminance_lux": 10, "keys": [
      {"time": 0, "direction": [0.5, -1, -0.4]}, {"time": 1, "direction": [-0.5, -1, -0.6]}]},
      {"name": "lamp", "kind": "point", "intensity_candela": 1, "keys": [
      {"time": 0, "position": [0, 1, 0]}, {"time": 1, "position": [0.5, 1, 1]}]}]})");
}

}  // namespace clpv::test
