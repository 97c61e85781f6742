// SPDX-License-Identifier: MIT
// Image codecs of OpenImageIO. Uses nothing else of clpv, since it is a module of the program.
#include "image/codec.hpp"

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <cstddef>
#include <cstring>
#include <string_view>

namespace clpv {
namespace {

constexpr std::string_view kMetadataPrefix = "clpv:";
// Date of all EXR files in place of the time of writing, so that equal images give equal bytes.
constexpr const char* kFixedDate = "1970:01:01 00:00:00";

/// First line of an OpenImageIO message, which may repeat itself over several lines.
std::string first_line(const std::string& message) {
  const std::string line = message.substr(0, message.find('\n'));
  return line.empty() ? "no reason given" : line;
}

/// Rejects offsets outside the bytes. OpenImageIO 2.4's reader copies from before the bytes for
/// negative offsets, which the chunk tables of an EXR may contain.
class MemoryReader : public OIIO::Filesystem::IOMemReader {
 public:
  /// Borrows the bytes.
  explicit MemoryReader(std::span<const std::uint8_t> bytes)
      : IOMemReader(bytes.data(), bytes.size()) {}

  bool seek(std::int64_t offset) override { return holds(offset) && IOMemReader::seek(offset); }

  std::size_t pread(void* to, std::size_t count, std::int64_t offset) override {
    if (!holds(offset)) return 0;
    return IOMemReader::pread(to, std::min(count, size() - static_cast<std::size_t>(offset)),
                              offset);
  }

 private:
  bool holds(std::int64_t offset) const {
    return offset >= 0 && static_cast<std::size_t>(offset) <= size();
  }
};

CodedImage description_of(const OIIO::ImageSpec& spec) {
  CodedImage image{.width = spec.width,
                   .height = spec.height,
                   .channels = spec.channelnames,
                   .metadata = {},
                   .tile_width = spec.tile_width,
                   .tile_height = spec.tile_height,
                   .deep = spec.deep || spec.depth > 1};
  for (const OIIO::ParamValue& value : spec.extra_attribs) {
    const std::string name = value.name().string();
    if (!name.starts_with(kMetadataPrefix) || value.type() != OIIO::TypeString) continue;
    image.metadata[name.substr(kMetadataPrefix.size())] = value.get_string();
  }
  return image;
}

class Decoder : public ImageDecoder {
 public:
  explicit Decoder(std::span<const std::uint8_t> bytes) : memory_(bytes) {}

  std::string open(const std::string& format, const std::string& name) {
    input_ = OIIO::ImageInput::create(format);
    if (!input_) return "OpenImageIO has no " + format + ": " + first_line(OIIO::geterror());
    input_->set_ioproxy(&memory_);
    OIIO::ImageSpec spec, config;
    config.attribute("oiio:UnassociatedAlpha", 1);
    if (!input_->open(name, spec, config)) return first_line(input_->geterror());
    take(spec);
    return {};
  }

  std::string select(int part) override {
    if (part == part_) return {};
    if (!input_->seek_subimage(part, 0)) return first_line(input_->geterror());
    part_ = part;
    take(input_->spec());
    return {};
  }

  const CodedImage& described() const override { return described_; }

  std::string read(float* pixels) override {
    for (int c = 0; c < spec_.nchannels; ++c)
      if (spec_.channelformat(c) == OIIO::TypeUInt32) return read_numbers(pixels);
    return read(OIIO::TypeFloat, pixels);
  }
  std::string read(std::uint8_t* pixels) override { return read(OIIO::TypeUInt8, pixels); }

 private:
  void take(const OIIO::ImageSpec& spec) {
    spec_ = spec;
    described_ = description_of(spec);
    described_.channels.resize(static_cast<std::size_t>(spec.nchannels));
  }

  std::string read(OIIO::TypeDesc type, void* pixels) {
    return input_->read_image(part_, 0, 0, spec_.nchannels, type, pixels)
               ? ""
               : first_line(input_->geterror());
  }

  /// Converts each channel from its own type. OpenImageIO would divide integers by 2^32 - 1.
  std::string read_numbers(float* pixels) {
    std::vector<unsigned char> coded(spec_.image_bytes(true));
    const std::string error = read(OIIO::TypeUnknown, coded.data());
    if (!error.empty()) return error;
    const std::size_t channels = static_cast<std::size_t>(spec_.nchannels),
                      pixel = spec_.pixel_bytes(true), count = coded.size() / pixel;
    const unsigned char* from = coded.data();
    for (int c = 0; c < spec_.nchannels; ++c, ++pixels) {
      const OIIO::TypeDesc type = spec_.channelformat(c);
      for (std::size_t i = 0; i < count && type == OIIO::TypeUInt32; ++i) {
        std::uint32_t number;
        std::memcpy(&number, from + i * pixel, sizeof number);
        pixels[i * channels] = static_cast<float>(number);
      }
      if (type != OIIO::TypeUInt32) {
        OIIO::convert_image(1, spec_.width, spec_.height, 1, from, type, pixel, OIIO::AutoStride,
                            OIIO::AutoStride, pixels, OIIO::TypeFloat, channels * sizeof(float),
                            OIIO::AutoStride, OIIO::AutoStride);
      }
      from += type.size();
    }
    return {};
  }

  MemoryReader memory_;
  std::unique_ptr<OIIO::ImageInput> input_;
  OIIO::ImageSpec spec_;
  int part_ = 0;
  CodedImage described_;
};

OIIO::ImageSpec spec_of(const CodedImage& image, OIIO::TypeDesc type) {
  OIIO::ImageSpec spec(image.width, image.height, static_cast<int>(image.channels.size()), type);
  spec.channelnames = image.channels;
  for (const auto& [name, value] : image.metadata)
    spec.attribute(std::string(kMetadataPrefix) + name, value);
  return spec;
}

std::string encode(const char* format, const OIIO::ImageSpec& spec, const void* pixels,
                   std::vector<unsigned char>& bytes) {
  OIIO::Filesystem::IOVecOutput memory(bytes);
  const auto output = OIIO::ImageOutput::create(format);
  if (!output) return std::string("OpenImageIO cannot write ") + format;
  output->set_ioproxy(&memory);
  const bool written = output->open(std::string("image.") + format, spec) &&
                       output->write_image(spec.format, pixels) && output->close();
  return written ? "" : first_line(output->geterror());
}

class Codec : public ImageCodec {
 public:
  std::unique_ptr<ImageDecoder> open(const std::string& format, const std::string& name,
                                     std::span<const std::uint8_t> bytes,
                                     std::string& error) const override {
    auto decoder = std::make_unique<Decoder>(bytes);
    error = decoder->open(format, name);
    if (!error.empty()) return nullptr;
    return decoder;
  }

  std::string encode_exr(const CodedImage& image, const float* pixels,
                         std::vector<unsigned char>& bytes) const override {
    OIIO::ImageSpec spec = spec_of(image, OIIO::TypeFloat);
    spec.attribute("compression", "zip");
    spec.attribute("oiio:ColorSpace", "Linear");
    spec.attribute("DateTime", kFixedDate);
    return encode("openexr", spec, pixels, bytes);
  }

  std::string encode_png(const CodedImage& image, const std::uint8_t* pixels,
                         std::vector<unsigned char>& bytes) const override {
    OIIO::ImageSpec spec = spec_of(image, OIIO::TypeUInt8);
    if (image.channels.size() == 4) spec.alpha_channel = 3;
    spec.attribute("oiio:UnassociatedAlpha", 1);
    spec.attribute("oiio:ColorSpace", "sRGB");
    return encode("png", spec, pixels, bytes);
  }
};

}  // namespace
}  // namespace clpv

extern "C" __attribute__((visibility("default"))) const clpv::ImageCodec* clpv_image_codec() {
  static const clpv::Codec codec;
  return &codec;
}
