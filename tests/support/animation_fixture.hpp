// SPDX-License-Identifier: MIT
// The common ground of tests of animations: a triangle, and channels that move it.
#pragma once

#include "tests/support/bad_input.hpp"

namespace clpv::test {

/// The triangle of BadInputTest at node 0, and what moves it.
struct AnimationTest : BadInputTest {
  /// A channel with a sampler of its own.
  template <typename T>
  json& animate(int node, const std::string& path, const std::vector<float>& times,
                const std::vector<T>& values, const std::string& interpolation = "LINEAR") {
    if (!model.document.contains("animations"))
      model.add("animations", {{"samplers", json::array()}, {"channels", json::array()}});
    json& animation = model.document["animations"].back();
    const std::string type = path == "rotation" ? "VEC4" : path == "weights" ? "SCALAR" : "VEC3";
    animation["channels"].push_back(
        {{"sampler", animation["samplers"].size()}, {"target", {{"node", node}, {"path", path}}}});
    animation["samplers"].push_back({{"input", model.accessor<float>("SCALAR", times)},
                                     {"output", model.accessor<T>(type, values, !std::is_same_v<T, float>)},
                                     {"interpolation", interpolation}});
    return animation;
  }

  MovingScene load() { return MovingScene(model.write(folder)); }
  json& sampler() { return model.document["animations"][0]["samplers"][0]; }
  json& accessor_of(const char* which) {
    return model.document["accessors"][sampler()[which].get<std::size_t>()];
  }
};

}  // namespace clpv::test
