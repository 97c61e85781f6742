// SPDX-License-Identifier: MIT
// A texture: bytes of a buffer, which say themselves whether they are a PNG, a JPEG or a WebP.
#include <span>

#include "image/image_header.hpp"
#include "scene/gltf_parts.hpp"
#include "tests/fuzz/fuzz.hpp"

namespace {

/// Larger images take a decoder seconds and find no further faults.
constexpr std::uint32_t kSide = 512;

bool is_small(std::span<const std::uint8_t> bytes) {
  const auto header = clpv::read_image_header(bytes);
  return !header || (header->width <= kSide && header->height <= kSide);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace clpv;
  if (size == 0 || !is_small({data, size})) return 0;
  GltfDocument document;
  document.file = "fuzzed.glb";
  document.model.buffers.emplace_back().data.assign(data, data + size);
  tinygltf::BufferView view;
  view.buffer = 0;
  view.byteOffset = 0;
  view.byteLength = size;
  document.model.bufferViews.push_back(view);
  document.model.images.emplace_back().bufferView = 0;
  fuzz::read_or_reject({ExitCode::bad_input}, [&] { load_textures(document, {{0, 0, 0}}); });
  return 0;
}
