// SPDX-License-Identifier: MIT
// An image as clpv compare reads it (EXR, PNG, HDR, by content), held against itself and against its difference image.
#include "image/compare.hpp"
#include "image/image_io.hpp"
#include "tests/fuzz/fuzz.hpp"

namespace {

/// Small: a decoder's time goes by what a header asks for.
constexpr clpv::ImageLimits kLimits{
    .file_bytes = 1 << 20, .side = 512, .channels = 32, .pixel_bytes = 1 << 22};

const char* name_for(std::string_view bytes) {
  if (bytes.starts_with("\x89P")) return "image.png";
  if (bytes.starts_with("#?")) return "image.hdr";
  return "image.exr";
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace clpv;
  const std::string_view bytes = fuzz::text_of(data, size);
  const auto path = fuzz::folder().write(name_for(bytes), bytes);
  fuzz::read_or_refuse({ExitCode::bad_input}, [&] {
    const Image image = read_image(path, kLimits);
    for (const std::string& layer : layers(image)) {
      fuzz::read_or_refuse({ExitCode::bad_input}, [&] {
        const Image one = extract_layer(image, layer, "fuzzed");
        if (!compare(one, "a", one, "b").identical) std::abort();
        difference_image(one, one, 15);
      });
    }
  });
  return 0;
}
