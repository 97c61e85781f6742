// SPDX-License-Identifier: MIT
// A scene file, with a valid model (sound.gltf) in the same folder.
#include "tests/fuzz/model.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  clpv::fuzz::load_model("scene.json", clpv::fuzz::text_of(data, size));
  return 0;
}
