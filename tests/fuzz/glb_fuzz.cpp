// SPDX-License-Identifier: MIT
// A .glb, chunks of JSON and of bytes: loaded as any model.
#include "tests/fuzz/model.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  clpv::fuzz::load_model("model.glb", clpv::fuzz::text_of(data, size));
  return 0;
}
