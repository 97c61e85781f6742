// SPDX-License-Identifier: MIT
// Interface to the image codecs of OpenImageIO, whose 260 shared libraries take 0.3 s to load. The
// library links them (linked_codec.cpp). The program loads them as a module with its first image
// (host/loaded_codec.cpp).
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace clpv {

/// Description of an encoded image.
struct CodedImage {
  int width = 0, height = 0;
  std::vector<std::string> channels;
  std::map<std::string, std::string> metadata;
  int tile_width = 0, tile_height = 0;  ///< 0 without tiles
  bool deep = false;                    ///< or a volume
};

/// An open image, whose pixels can be read once.
class ImageDecoder {
 public:
  virtual ~ImageDecoder() = default;
  /// Turns to a part of an EXR; the first is open. Returns the reason of a failure, else "".
  virtual std::string select(int part) = 0;
  /// Describes the part that is open.
  virtual const CodedImage& described() const = 0;
  /// Read all channels of its pixels: channels of 32-bit integers as these numbers, other integers
  /// relative to their largest value. Return the reason of a failure, else "".
  virtual std::string read(float* pixels) = 0;
  virtual std::string read(std::uint8_t* pixels) = 0;
};

class ImageCodec {
 public:
  virtual ~ImageCodec() = default;
  /// Opens an image of format "openexr", "png", "jpeg" or "webp"; the bytes must outlive it.
  /// Colours are not multiplied by alpha, except in WebP. Returns null and sets `error` on failure.
  /// `name`: for errors.
  virtual std::unique_ptr<ImageDecoder> open(const std::string& format, const std::string& name,
                                             std::span<const std::uint8_t> bytes,
                                             std::string& error) const = 0;
  /// Encode pixels into `bytes`. Return the reason of a failure, else "".
  virtual std::string encode_exr(const CodedImage& image, const float* pixels,
                                 std::vector<unsigned char>& bytes) const = 0;
  virtual std::string encode_png(const CodedImage& image, const std::uint8_t* pixels,
                                 std::vector<unsigned char>& bytes) const = 0;
};

/// The codecs, linked or loaded. Throws Error(run_time) if they cannot be loaded.
const ImageCodec& image_codec();

/// Codecs of a build without OpenImageIO: they write without compression (open_plain() says
/// what they read).
const ImageCodec& plain_codec();

/// Opens a PNG of 8 bits or a JPEG (stb_image), or an EXR as plain_codec() writes it: rows of
/// floats without compression, whose header read_exr_header() accepted. Returns null and sets
/// `error` for others.
std::unique_ptr<ImageDecoder> open_plain(const std::string& format,
                                         std::span<const std::uint8_t> bytes, std::string& error);

/// Name and type of the function that makes the codecs, in the library and in the module.
inline constexpr const char* kGetImageCodec = "clpv_image_codec";
using GetImageCodec = const ImageCodec*();

}  // namespace clpv
