// SPDX-License-Identifier: MIT
// `clpv quality` of a small room with two cameras.
#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <string>

#include "tests/support/gltf_builder.hpp"
#include "tests/support/run_here.hpp"
#include "tests/support/scenes.hpp"

namespace clpv::test {

/// A floor and a wall, both 4 x 4 m, lit from the front.
inline void write_room(const TemporaryFolder& folder) {
  GltfBuilder room;
  room.square(2);
  room.add(
      "nodes",
      {{"mesh", 0}, {"rotation", {0.70710678, 0, 0, 0.70710678}}, {"translation", {0, 0, -2}}});
  room.write(folder);
  folder.write("room.json", R"({"model": "model.gltf", "cascades": {"count": 1, "size_metres": 20},
    "cameras": [{"name": "left", "eye": [-1, 1.5, 3], "target": [0, 0.5, -1]},
                {"name": "right", "eye": [1, 1.5, 3], "target": [0, 0.5, -1]}],
    "lights": [{"name": "sun", "kind": "directional", "direction": [0, -1, -0.5], "illuminance_lux": 5}]})");
}

struct QualityCommand : ::testing::Test {
  void SetUp() override { write_room(folder_); }

  std::string method = kSweepOfOne;
  Outcome quality(const std::string& arguments, const Additions& additions = {}) const {
    return run_here("quality " + file("room.json") + " --cache " + file("cache") +
                        " --width 32 --height 18 --spp 64 --frames 1 --rsm-size 64 " + method +
                        arguments,
                    ".", additions);
  }
  std::string file(const std::string& name) const { return (folder_ / name).string(); }
  std::size_t kept() const {
    return std::distance(std::filesystem::directory_iterator(file("cache/cells")), {});
  }

  TemporaryFolder folder_;
};

}  // namespace clpv::test
