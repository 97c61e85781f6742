// SPDX-License-Identifier: MIT
// Writes EXR without compression and PNG, for a build without OpenImageIO (CLPV_IMAGES=OFF), and
// reads what open_plain() names.
#include <algorithm>
#include <cstdlib>
#include <numeric>
#include <string_view>

#include "image/codec.hpp"
#include "support/bytes.hpp"

#define STB_IMAGE_WRITE_IMPLEMENTATION
#define STB_IMAGE_WRITE_STATIC
#define STBI_WRITE_NO_STDIO
#include <stb/stb_image_write.h>

namespace clpv {
namespace {

using EncodedBytes = std::vector<unsigned char>;

void append_text(EncodedBytes& to, std::string_view text) {
  to.insert(to.end(), text.begin(), text.end());
}

/// Text and the 0 that ends it.
void append_name(EncodedBytes& to, std::string_view text) {
  append_text(to, text);
  to.push_back(0);
}

void append_big(EncodedBytes& to, std::uint32_t value) {
  for (int shift = 24; shift >= 0; shift -= 8)
    to.push_back(static_cast<unsigned char>(value >> shift));
}

// EXR (OpenEXR's documentation, "File Layout"): rows of pixels, each with its channels one after
// the other, in the order of their names.

constexpr std::size_t kShortName = 31;  // longer names need a flag
constexpr unsigned kLongNames = 0x400, kVersion = 2;

void append_attribute(EncodedBytes& to, std::string_view name, std::string_view type,
                      const EncodedBytes& value) {
  append_name(to, name);
  append_name(to, type);
  append_little(to, static_cast<std::uint32_t>(value.size()));
  to.insert(to.end(), value.begin(), value.end());
}

/// Numbers of an image's channels in the order of their names.
std::vector<std::size_t> order_of(const std::vector<std::string>& channels) {
  std::vector<std::size_t> order(channels.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::sort(order, {}, [&](std::size_t c) { return channels[c]; });
  return order;
}

EncodedBytes channel_list(const CodedImage& image) {
  constexpr int kFloat = 2;
  EncodedBytes list;
  for (const std::size_t c : order_of(image.channels)) {
    append_name(list, image.channels[c]);
    append_little(list, kFloat, 0, 1, 1);
  }
  list.push_back(0);
  return list;
}

EncodedBytes exr_header(const CodedImage& image) {
  const auto is_long = [](const std::string& name) { return name.size() > kShortName; };
  bool long_names = std::ranges::any_of(image.channels, is_long);
  EncodedBytes box, header{0x76, 0x2f, 0x31, 0x01};
  append_little(box, 0, 0, image.width - 1, image.height - 1);
  EncodedBytes attributes;
  append_attribute(attributes, "channels", "chlist", channel_list(image));
  append_attribute(attributes, "compression", "compression", {0});
  append_attribute(attributes, "dataWindow", "box2i", box);
  append_attribute(attributes, "displayWindow", "box2i", box);
  append_attribute(attributes, "lineOrder", "lineOrder", {0});
  EncodedBytes one, centre(8, 0);
  append_little(one, 1.0f);
  append_attribute(attributes, "pixelAspectRatio", "float", one);
  append_attribute(attributes, "screenWindowCenter", "v2f", centre);
  append_attribute(attributes, "screenWindowWidth", "float", one);
  for (const auto& [name, value] : image.metadata) {
    const std::string attribute = "clpv:" + name;
    long_names = long_names || is_long(attribute);
    append_attribute(attributes, attribute, "string", {value.begin(), value.end()});
  }
  append_little(header, kVersion | (long_names ? kLongNames : 0));
  header.insert(header.end(), attributes.begin(), attributes.end());
  header.push_back(0);
  return header;
}

EncodedBytes plain_exr(const CodedImage& image, const float* pixels) {
  EncodedBytes bytes = exr_header(image);
  const std::vector<std::size_t> order = order_of(image.channels);
  const auto width = static_cast<std::size_t>(image.width),
             height = static_cast<std::size_t>(image.height), channels = order.size(),
             row = width * channels * sizeof(float), first = bytes.size() + 8 * height;
  for (std::size_t y = 0; y < height; ++y)
    append_little(bytes, std::uint64_t{first + y * (8 + row)});
  for (std::size_t y = 0; y < height; ++y) {
    append_little(bytes, static_cast<std::uint32_t>(y), static_cast<std::uint32_t>(row));
    for (const std::size_t c : order) {
      for (std::size_t x = 0; x < width; ++x)
        append_little(bytes, pixels[(y * width + x) * channels + c]);
    }
  }
  return bytes;
}

// PNG by stb_image_write, with further chunks (W3C, "Portable Network Graphics", third edition).

void append_chunk(EncodedBytes& to, std::string_view type, const EncodedBytes& data) {
  append_big(to, static_cast<std::uint32_t>(data.size()));
  const std::size_t start = to.size();
  append_text(to, type);
  to.insert(to.end(), data.begin(), data.end());
  append_big(to, crc32(std::as_bytes(std::span(to).subspan(start))));
}

/// Empty if memory is short.
EncodedBytes plain_png(const CodedImage& image, const std::uint8_t* pixels) {
  constexpr std::ptrdiff_t kHeader = 33;  // bytes of the signature and of IHDR
  int size = 0;
  const std::unique_ptr<unsigned char, void (*)(void*)> png(
      stbi_write_png_to_mem(pixels, 0, image.width, image.height,
                            static_cast<int>(image.channels.size()), &size),
      std::free);
  if (!png) return {};
  EncodedBytes bytes(png.get(), png.get() + kHeader);
  append_chunk(bytes, "sRGB", {0});
  for (const auto& [name, value] : image.metadata) {
    EncodedBytes text;
    append_name(text, "clpv:" + name);
    append_text(text, value);
    append_chunk(bytes, "tEXt", text);
  }
  bytes.insert(bytes.end(), png.get() + kHeader, png.get() + size);
  return bytes;
}

class PlainCodec : public ImageCodec {
 public:
  std::unique_ptr<ImageDecoder> open(const std::string& format, const std::string&,
                                     std::span<const std::uint8_t> bytes,
                                     std::string& error) const override {
    return open_plain(format, bytes, error);
  }

  std::string encode_exr(const CodedImage& image, const float* pixels,
                         EncodedBytes& bytes) const override {
    bytes = plain_exr(image, pixels);
    return {};
  }

  std::string encode_png(const CodedImage& image, const std::uint8_t* pixels,
                         EncodedBytes& bytes) const override {
    bytes = plain_png(image, pixels);
    return bytes.empty() ? "out of memory" : "";
  }
};

}  // namespace

const ImageCodec& plain_codec() {
  static const PlainCodec codec;
  return codec;
}

}  // namespace clpv
