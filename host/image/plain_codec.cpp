// SPDX-License-Identifier: MIT
// Writes EXR without compression and PNG, for a build without OpenImageIO (CLPV_IMAGES=OFF), and
// reads what open_plain() names.

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <limits>
#include <numeric>
#include <string_view>

#include "image/codec.hpp"
#include "image/image_header.hpp"
#include "support/array_files.hpp"

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

struct PlainCodec : ImageCodec {
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
// Decoders of a build without OpenImageIO (CLPV_IMAGES=OFF).

#define STB_IMAGE_IMPLEMENTATION
#define STB_IMAGE_STATIC
#define STBI_NO_STDIO
#define STBI_ONLY_JPEG
#define STBI_ONLY_PNG
#include <stb/stb_image.h>

namespace clpv {
namespace {

/// Metadata of a PNG, from chunks tEXt: "clpv:NAME", a zero and the text.
void read_texts(CodedImage& image, std::span<const std::uint8_t> png) {
  visit_png_chunks(png, [&](std::string_view type, std::span<const std::uint8_t> chunk) {
    constexpr std::string_view kPrefix = "clpv:";
    const std::string data(chunk.begin() + 8, chunk.end() - 4);
    const std::size_t zero = data.find('\0');
    if (type == "tEXt" && data.starts_with(kPrefix) && zero != std::string::npos)
      image.metadata[data.substr(kPrefix.size(), zero - kPrefix.size())] = data.substr(zero + 1);
  });
}

class PlainDecoder : public ImageDecoder {
 public:
  std::string select(int) override { return {}; }
  const CodedImage& described() const override { return image_; }

 protected:
  CodedImage image_;
};

/// A PNG or JPEG, decoded when it is opened.
class BytePixels : public PlainDecoder {
 public:
  std::string open(const std::string& format, std::span<const std::uint8_t> bytes) {
    if (bytes.size() > std::size_t{std::numeric_limits<int>::max()}) return "over 2 GiB";
    const auto size = static_cast<int>(bytes.size());
    if (stbi_is_16_bit_from_memory(bytes.data(), size) != 0)
      return "16 bits per channel; a build without OpenImageIO decodes 8";
    int channels = 0;
    const std::unique_ptr<stbi_uc, void (*)(void*)> pixels(
        stbi_load_from_memory(bytes.data(), size, &image_.width, &image_.height, &channels, 0),
        stbi_image_free);
    if (!pixels) return stbi_failure_reason();
    image_.channels =
        channels < 3 ? std::vector<std::string>{"Y"} : std::vector<std::string>{"R", "G", "B"};
    if (channels % 2 == 0) image_.channels.push_back("A");
    pixels_.assign(pixels.get(), pixels.get() + static_cast<std::size_t>(image_.width) *
                                                    static_cast<std::size_t>(image_.height) *
                                                    image_.channels.size());
    if (format == "png") read_texts(image_, bytes);
    return {};
  }
  std::string read(float* pixels) override {
    constexpr float kUnit = 1.0f / 255;
    std::ranges::transform(pixels_, pixels, [](std::uint8_t value) { return kUnit * value; });
    return {};
  }
  std::string read(std::uint8_t* pixels) override {
    std::ranges::copy(pixels_, pixels);
    return {};
  }

 private:
  std::vector<std::uint8_t> pixels_;
};

/// EXR (OpenEXR's documentation, "File Layout").
class PlainExr : public PlainDecoder {
 public:
  explicit PlainExr(std::span<const std::uint8_t> bytes) : bytes_(bytes) {}

  std::string open() {
    constexpr std::uint32_t kVersion = 2, kLongNames = 0x400;
    const ExrHeader header = read_exr_header("image", bytes_).front();
    if ((little_endian(bytes_, 4) & ~kLongNames) != kVersion || header.compression != 0 ||
        !header.floats)
      return kOthers;
    image_.width = static_cast<int>(header.width), image_.height = static_cast<int>(header.height);
    image_.channels = header.channel_names, image_.metadata = header.metadata;
    at_ = header.end;
    const std::size_t rows = (bytes_.size() - at_) / sizeof(std::uint64_t);
    return std::int64_t{image_.height} <= static_cast<std::int64_t>(rows) ? "" : "no table of rows";
  }
  std::string read(float* pixels) override {
    const auto width = static_cast<std::size_t>(image_.width), channels = image_.channels.size(),
               row = width * channels * sizeof(float), head = std::size_t{8};
    for (std::size_t y = 0; y < static_cast<std::size_t>(image_.height); ++y) {
      const auto from = little_endian<std::uint64_t>(bytes_, at_ + 8 * y);
      if (from > bytes_.size() || bytes_.size() - from < head + row)
        return "row " + std::to_string(y) + " lies beyond the end of the file";
      for (std::size_t c = 0; c < channels; ++c) {
        for (std::size_t x = 0; x < width; ++x)
          std::memcpy(&pixels[(y * width + x) * channels + c],
                      &bytes_[from + head + (c * width + x) * sizeof(float)], sizeof(float));
      }
    }
    return {};
  }
  std::string read(std::uint8_t*) override { return "floats, not bytes"; }

 private:
  static constexpr const char* kOthers =
      "this clpv was built without OpenImageIO (CLPV_IMAGES=OFF); it decodes EXR of floats in rows "
      "without compression only";

  std::span<const std::uint8_t> bytes_;
  std::size_t at_ = 0;  ///< after open(): the table of offsets of rows
};

}  // namespace

std::unique_ptr<ImageDecoder> open_plain(const std::string& format,
                                         std::span<const std::uint8_t> bytes, std::string& error) {
  if (format == "openexr") {
    auto exr = std::make_unique<PlainExr>(bytes);
    error = exr->open();
    if (error.empty()) return exr;
  } else if (format == "png" || format == "jpeg") {
    auto pixels = std::make_unique<BytePixels>();
    error = pixels->open(format, bytes);
    if (error.empty()) return pixels;
  } else {
    error = "this clpv was built without OpenImageIO (CLPV_IMAGES=OFF); it decodes no " + format;
  }
  return nullptr;
}

}  // namespace clpv
