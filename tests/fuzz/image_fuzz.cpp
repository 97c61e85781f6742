// SPDX-License-Identifier: MIT
// An image as clpv compare reads it (EXR, PNG, HDR, by content), held against itself and against
// its difference image. The walk through an EXR's headers must see what OpenEXR reads.
#include <span>

#include "image/compare.hpp"
#include "image/image_header.hpp"
#include "image/image_io.hpp"
#include "tests/fuzz/fuzz.hpp"

namespace {

/// Small, since a decoder's time depends on the header.
constexpr clpv::ImageLimits kLimits{
    .file_bytes = 1 << 20, .side = 512, .channels = 32, .pixel_bytes = 1 << 22};

const char* name_for(std::string_view bytes) {
  if (bytes.starts_with("\x89P")) return "image.png";
  if (bytes.starts_with("#?")) return "image.hdr";
  return "image.exr";
}

void hold_against_header(const clpv::Image& image, const char* name,
                         std::span<const unsigned char> bytes) {
  std::int64_t channels = 0;
  for (const clpv::ExrHeader& part : clpv::read_exr_header(name, bytes)) {
    channels += part.channels;
    if (part.display.width() != image.width || part.display.height() != image.height) std::abort();
  }
  // Channels of one name count once for OpenEXR.
  if (channels < static_cast<std::int64_t>(image.channels.size())) std::abort();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace clpv;
  const std::string_view bytes = fuzz::text_of(data, size);
  const char* const name = name_for(bytes);
  const auto path = fuzz::folder().write(name, bytes);
  fuzz::read_or_reject({ExitCode::bad_input}, [&] {
    const Image image = read_image(path, kLimits);
    if (path.extension() == ".exr") hold_against_header(image, name, {data, size});
    for (const std::string& layer : layers(image)) {
      fuzz::read_or_reject({ExitCode::bad_input}, [&] {
        const Image one = extract_layer(image, layer, "fuzzed");
        if (!compare(one, "a", one, "b").identical) std::abort();
        difference_image(one, one, 15);
      });
    }
  });
  return 0;
}
