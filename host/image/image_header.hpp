// SPDX-License-Identifier: MIT
// Size of an encoded image by its header, read without decoding, and removal of unneeded chunks.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <glm/mat3x3.hpp>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "image/codec.hpp"
#include "image/image_io.hpp"
#include "support/named_enum.hpp"

namespace clpv {

// Conversion of linear RGB between primaries.

/// CIE x and y of red, green, blue and white.
using Chromaticities = std::array<double, 8>;

/// Rec. 709 (ITU-R BT.709-6, table 1), whose primaries sRGB shares.
inline constexpr Chromaticities kRec709 = {0.64, 0.33, 0.3, 0.6, 0.15, 0.06, 0.3127, 0.3290};

/// True within the digits to which standards state chromaticities.
bool is_rec709(const Chromaticities& chromaticities);

/// Matrix from linear RGB of these primaries to Rec. 709. Bradford's transform adapts the white, so
/// grey stays grey (as OpenEXR's reader of ACES files does). Empty if they span no colours.
std::optional<glm::dmat3> to_rec709(const Chromaticities& chromaticities);

/// "0.64,0.33 0.3,0.6 0.15,0.06, white 0.3127,0.329"
std::string text_of(const Chromaticities& chromaticities);

/// Size of an image as its file declares it, unchecked.
struct DeclaredImage {
  std::int64_t width = 0, height = 0;  ///< size of the data window [pixels]
  /// Size of a tile, or of the rows decoded at once [pixels].
  std::int64_t chunk_width = 0, chunk_height = 0;
  std::int64_t channels = 0;
  bool tiled = false;
  bool deep = false;  ///< deep image or volume
};

/// Rectangle of an EXR file's pixels, both corners included.
struct ExrWindow {
  std::int64_t left = 0, top = 0, right = -1, bottom = -1;
  bool operator==(const ExrWindow&) const = default;
  std::int64_t width() const { return right - left + 1; }
  std::int64_t height() const { return bottom - top + 1; }
};

/// Header of one part of an EXR file; its size is that of the data window.
struct ExrHeader : DeclaredImage {
  std::string name;
  ExrWindow data;
  ExrWindow display;  ///< the data window if the file has no other
  std::optional<Chromaticities> chromaticities;
  bool cube_map = false;
  std::vector<std::string> channel_names;
  bool floats = true;                           ///< all channels are of 32-bit floats
  int compression = 0;                          ///< 0: none
  std::map<std::string, std::string> metadata;  ///< texts "clpv:NAME", by NAME
  std::size_t end = 0;                          ///< bytes of the file up to the header's end
};

enum class ImageFormat { png, jpeg, webp };

template <>
inline constexpr auto kNames<ImageFormat> = name_list("png", "jpeg", "webp");

struct ImageHeader {
  ImageFormat format;
  std::uint32_t width, height;
  bool complete;  ///< the end marker is present, and all chunks fit into the file
};

/// Reads the header of a PNG, JPEG or WebP; empty for other or truncated bytes, and for an animated
/// WebP.
std::optional<ImageHeader> read_image_header(std::span<const std::uint8_t> bytes);

/// Calls visit(type, chunk) for each chunk of a PNG up to IEND: 8 bytes, the data, and 4 bytes of a
/// checksum. Returns false if a chunk exceeds the bytes.
bool visit_png_chunks(
    std::span<const std::uint8_t> png,
    const std::function<void(std::string_view, std::span<const std::uint8_t>)>& visit);

/// Copies a complete PNG with only those chunks that its pixels need, and uncompressed texts.
/// libpng would allocate memory for the declared size of compressed ones.
std::vector<std::uint8_t> strip_png(std::span<const std::uint8_t> bytes);

/// Copies a complete WebP with only the chunks that its pixels need. Without `alpha` the copy is
/// opaque: OpenImageIO multiplies colours by alpha, which 8 bits do not undo.
std::vector<std::uint8_t> strip_webp(std::span<const std::uint8_t> bytes, bool alpha);

/// Returns the colour data of a complete PNG that says otherwise than sRGB, such as "gAMA 1"; empty
/// if there is none. A chunk sRGB overrides the others.
std::string foreign_colour(std::span<const std::uint8_t> png);

/// Returns the headers of all parts of an OpenEXR file (OpenEXR's documentation, "File Layout").
/// Rejects those that OpenImageIO 2.4 reads without end, crashes on or takes much memory for:
/// values longer than the file, channels of one name, over 1024 attributes, parts of unknown types.
/// Throws Error(bad_input) that names the file, part, attribute, value found and value allowed.
std::vector<ExrHeader> read_exr_header(const std::filesystem::path& path,
                                       std::span<const unsigned char> bytes);

// Decoders of single formats, for image_io.cpp, and the checks that they share.

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
