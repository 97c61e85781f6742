// SPDX-License-Identifier: MIT
// Decoders of single formats, for image_io.cpp, and the checks that they share.
#pragma once

#include <span>

#include "image/codec.hpp"
#include "image/image_header.hpp"
#include "image/image_io.hpp"

namespace clpv {

[[noreturn]] void reject_image(const std::filesystem::path& path, const std::string& reason);

/// Rejects an image, or its chunks, beyond the limits.
void check_size(const std::filesystem::path& path, const DeclaredImage& image,
                const ImageLimits& limits);

/// An image file whose header OpenImageIO accepted. The bytes must outlive it.
std::unique_ptr<ImageDecoder> open_decoder(const std::filesystem::path& path,
                                           const std::string& format,
                                           std::span<const std::uint8_t> bytes,
                                           const ImageLimits& limits);

/// Checks the size that a decoder declares for the part that is open.
void check_declared(const std::filesystem::path& path, const CodedImage& image,
                    const ImageLimits& limits);

/// Reads the pixels of a decoder's open part.
void read_pixels(const std::filesystem::path& path, ImageDecoder& decoder, float* pixels);

/// An EXR whose headers are checked.
class ExrFile {
 public:
  /// The bytes must outlive it.
  ExrFile(const std::filesystem::path& path, std::span<const std::uint8_t> bytes,
          const ImageLimits& limits);
  const std::map<std::string, std::string>& metadata() const;
  /// Decodes all parts. Pixels lie by their coordinates in the display window.
  Image decode();

 private:
  const CodedImage& open_part(std::size_t index);
  Image decode_part(std::size_t index);
  std::vector<std::string> channel_names();

  std::filesystem::path path_;
  ImageLimits limits_;
  std::vector<ExrHeader> parts_;
  std::unique_ptr<ImageDecoder> decoder_;
};

/// Decodes a Radiance picture with channels R, G and B: each EXPOSURE and COLORCORR is divided out,
/// any orientation is turned upright, PRIMARIES are converted to Rec. 709 (Radiance's "File
/// Formats", section "Picture Files"). Throws Error(bad_input).
Image decode_hdr(const std::filesystem::path& path, std::span<const std::uint8_t> bytes,
                 const ImageLimits& limits);

/// Converts R, G and B of each layer from these primaries to Rec. 709, and adds a note. Rejects
/// primaries that span no colours.
void convert_primaries(const std::filesystem::path& path, Image& image,
                       const Chromaticities& chromaticities);

}  // namespace clpv
