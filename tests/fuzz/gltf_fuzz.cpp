// SPDX-License-Identifier: MIT
// A .gltf, text: loaded, and shown at some instants if it moves. Beside it are model.bin and
// image.png for its URIs.
#include "tests/fuzz/model.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  clpv::fuzz::load_model("model.gltf", clpv::fuzz::text_of(data, size));
  return 0;
}
