// SPDX-License-Identifier: MIT
// Reads the headers of PNG (ISO 15948, section 11.2.2), JPEG (ITU T.81, annex B) and WebP files
// (RFC 9649). Decoders allocate by the header's size before the caller can check it: libjpeg for
// progressive images, OpenImageIO for interlaced ones, libwebp for all.

#include "image/image_header.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/glm.hpp>
#include <string_view>

#include "support/array_files.hpp"
#include "support/text.hpp"

namespace clpv {
namespace {

using Data = std::span<const std::uint8_t>;

std::string_view as_text(Data bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

constexpr std::string_view kPngSignature = "\x89PNG\r\n\x1a\n";
constexpr std::size_t kChunkData = 8, kChunkCheck = 4;  // bytes before and after a chunk's data

std::optional<ImageHeader> png_header(Data bytes) {
  // Signature, then the IHDR chunk.
  constexpr std::size_t kType = 12, kWidth = 16, kHeight = 20, kHeaderEnd = 33;
  if (bytes.size() < kHeaderEnd || !as_text(bytes).substr(kType).starts_with("IHDR"))
    return std::nullopt;
  return ImageHeader{ImageFormat::png, big_endian(bytes, kWidth, 4), big_endian(bytes, kHeight, 4),
                     visit_png_chunks(bytes, [](std::string_view, Data) {})};
}

std::optional<ImageHeader> jpeg_header(Data bytes) {
  for (std::size_t at = 2; at + 9 < bytes.size() && bytes[at] == 0xff;) {
    const std::uint8_t marker = bytes[at + 1];
    if (marker == 0xff) {  // fill byte
      ++at;
      continue;
    }
    // Frame headers are SOF0 to SOF15. The markers DHT, JPG and DAC lie in the same range.
    const bool frame =
        marker >= 0xc0 && marker <= 0xcf && marker != 0xc4 && marker != 0xc8 && marker != 0xcc;
    if (frame) {
      return ImageHeader{ImageFormat::jpeg, big_endian(bytes, at + 7, 2),
                         big_endian(bytes, at + 5, 2),
                         as_text(bytes).find("\xff\xd9", at) != std::string_view::npos};
    }
    at += 2 + big_endian(bytes, at + 2, 2);
  }
  return std::nullopt;
}

constexpr std::size_t kRiffHeader = 12, kRiffChunkHeader = 8;
constexpr std::uint32_t kWebpAlpha = 0x10;         // flag of the chunk VP8X
constexpr std::uint32_t kLosslessAlpha = 1 << 28;  // in the header of a VP8L image

/// Chunks of a still WebP, with their headers.
struct WebpChunks {
  Data image;            ///< "VP8 " (lossy) or "VP8L" (lossless)
  Data alpha;            ///< "ALPH" of a lossy image; may be empty
  bool complete = true;  ///< all chunks up to the image fit into the file
  bool lossless() const { return image[3] == 'L'; }
};

/// Finds the chunks of a still image; without `image` if there is none.
WebpChunks webp_chunks(Data bytes) {
  WebpChunks found;
  bool has_alpha = false;
  for (std::size_t at = kRiffHeader; bytes.size() - at >= kRiffChunkHeader;) {
    const std::string_view type = as_text(bytes).substr(at, 4);
    const std::size_t room = bytes.size() - at - kRiffChunkHeader,
                      size = little_endian(bytes, at + 4, 4), used = std::min(size, room);
    const Data chunk = bytes.subspan(at, kRiffChunkHeader + used);
    found.complete = size <= room;
    if (type == "VP8X" && used > 0)
      has_alpha = (little_endian(bytes, at + kRiffChunkHeader, 1) & kWebpAlpha) != 0;
    if (type == "ALPH" && has_alpha) found.alpha = chunk;
    if (type == "VP8 " || type == "VP8L") {
      found.image = chunk;
      break;
    }
    if (!found.complete) break;
    at += std::min(chunk.size() + size % 2, bytes.size() - at);
  }
  return found;
}

std::optional<ImageHeader> webp_header(Data bytes) {
  constexpr std::uint32_t kSide = 0x3fff;                        // 14 bits
  constexpr std::size_t kLossyHeader = 10, kLosslessHeader = 5;  // start and sides
  const WebpChunks chunks = webp_chunks(bytes);
  const Data image = chunks.image;
  if (image.empty() ||
      image.size() < kRiffChunkHeader + (chunks.lossless() ? kLosslessHeader : kLossyHeader))
    return std::nullopt;
  if (chunks.lossless()) {
    const std::uint32_t sides = little_endian(image, kRiffChunkHeader + 1, 4);
    if (image[kRiffChunkHeader] != 0x2f) return std::nullopt;
    return ImageHeader{ImageFormat::webp, (sides & kSide) + 1, (sides >> 14 & kSide) + 1,
                       chunks.complete};
  }
  if (!as_text(image).substr(kRiffChunkHeader + 3).starts_with("\x9d\x01\x2a")) return std::nullopt;
  return ImageHeader{ImageFormat::webp, little_endian(image, kRiffChunkHeader + 6, 2) & kSide,
                     little_endian(image, kRiffChunkHeader + 8, 2) & kSide, chunks.complete};
}

}  // namespace

bool visit_png_chunks(Data png, const std::function<void(std::string_view, Data)>& visit) {
  constexpr std::size_t kOverhead = kChunkData + kChunkCheck;
  for (std::size_t at = kPngSignature.size(); png.size() - at >= kOverhead;) {
    const std::size_t length = big_endian(png, at, 4);
    if (length > png.size() - at - kOverhead) return false;
    const std::string_view type = as_text(png).substr(at + 4, 4);
    visit(type, png.subspan(at, kOverhead + length));
    if (type == "IEND") return true;
    at += kOverhead + length;
  }
  return false;
}

std::optional<ImageHeader> read_image_header(Data bytes) {
  const std::string_view text = as_text(bytes);
  if (text.starts_with(kPngSignature)) return png_header(bytes);
  if (text.starts_with("\xff\xd8\xff")) return jpeg_header(bytes);
  const bool webp =
      bytes.size() >= kRiffHeader && text.starts_with("RIFF") && text.substr(8).starts_with("WEBP");
  return webp ? webp_header(bytes) : std::nullopt;
}

std::vector<std::uint8_t> strip_png(Data bytes) {
  constexpr std::array<std::string_view, 6> kKept = {"IHDR", "PLTE", "tRNS",
                                                     "tEXt", "IDAT", "IEND"};
  std::vector<std::uint8_t> kept(bytes.begin(), bytes.begin() + kPngSignature.size());
  visit_png_chunks(bytes, [&](std::string_view type, Data chunk) {
    if (std::ranges::find(kKept, type) != kKept.end())
      kept.insert(kept.end(), chunk.begin(), chunk.end());
  });
  return kept;
}

std::string foreign_colour(Data png) {
  constexpr double kUnit = 1e-5;  // unit of gAMA and cHRM
  constexpr double kSrgbGamma = 0.45455, kSameGamma = 5e-3;
  constexpr std::array<std::size_t, 8> kOrder = {6, 7, 0, 1, 2, 3, 4, 5};  // cHRM begins with white
  std::string found;
  bool srgb = false;
  visit_png_chunks(png, [&](std::string_view type, Data chunk) {
    const Data data = chunk.subspan(kChunkData, chunk.size() - kChunkData - kChunkCheck);
    if (type == "sRGB") srgb = true;
    if (type == "gAMA" && data.size() == 4) {
      const double gamma = kUnit * big_endian(data, 0, 4);
      if (std::abs(gamma - kSrgbGamma) > kSameGamma) found = fmt::format("gAMA {:.5g}", gamma);
    } else if (type == "cHRM" && data.size() == 32) {
      Chromaticities given;
      for (std::size_t i = 0; i < given.size(); ++i)
        given[kOrder[i]] = kUnit * big_endian(data, 4 * i, 4);
      if (!is_rec709(given)) found = fmt::format("cHRM {}", text_of(given));
    } else if (type == "iCCP" || type == "cICP") {
      const std::string name(data.begin(), std::ranges::find(data, 0));
      found = type == "iCCP" ? fmt::format("iCCP '{}'", printable(name)) : "cICP";
    }
  });
  return srgb ? "" : found;
}

std::vector<std::uint8_t> strip_webp(Data bytes, bool alpha) {
  const WebpChunks chunks = webp_chunks(bytes);
  const ImageHeader header = *webp_header(bytes);
  std::string content = "WEBP";
  const auto add = [&content](Data chunk) {
    content += as_text(chunk);
    if (chunk.size() % 2 != 0) content.push_back(0);
  };
  if (alpha && !chunks.lossless() && !chunks.alpha.empty()) {
    content += "VP8X";
    append_little(content, 10u, kWebpAlpha);
    for (const std::uint32_t side : {header.width - 1, header.height - 1})  // 24 bits
      append_little(content, static_cast<std::uint16_t>(side),
                    static_cast<std::uint8_t>(side >> 16));
    add(chunks.alpha);
  }
  const std::size_t image = content.size();
  add(chunks.image);
  if (!alpha && chunks.lossless())
    content[image + kRiffChunkHeader + 4] &= static_cast<char>(~(kLosslessAlpha >> 24));
  std::string file = "RIFF";
  append_little(file, static_cast<std::uint32_t>(content.size()));
  file += content;
  return {file.begin(), file.end()};
}

namespace {

// Standards state three or four digits.
constexpr double kSameChromaticity = 1e-3;
// Smaller determinants amplify the digits of the chromaticities more than a hundred times.
constexpr double kMinDeterminant = 1e-6;

/// Cone responses of CIE XYZ (Lam 1985, Metamerism and Colour Constancy), in columns.
const glm::dmat3 kBradford(0.8951, -0.7502, 0.0389, 0.2664, 1.7135, -0.0685, -0.1614, 0.0367,
                           1.0296);

/// XYZ of luminance 1.
glm::dvec3 xyz_of(double x, double y) {
  return {x / y, 1, (1 - x - y) / y};
}

glm::dvec3 white_of(const Chromaticities& c) {
  return xyz_of(c[6], c[7]);
}

/// Matrix from RGB to XYZ (SMPTE RP 177): columns are the primaries, scaled so that they sum to
/// white.
std::optional<glm::dmat3> to_xyz(const Chromaticities& c) {
  const auto primary = [&](int i) {
    return glm::dvec3(c[2 * i], c[2 * i + 1], 1 - c[2 * i] - c[2 * i + 1]);
  };
  const glm::dmat3 primaries(primary(0), primary(1), primary(2));
  if (!(std::abs(glm::determinant(primaries)) > kMinDeterminant && c[7] > kMinDeterminant))
    return std::nullopt;
  const glm::dvec3 scale = glm::inverse(primaries) * white_of(c);
  return glm::dmat3(scale.x * primaries[0], scale.y * primaries[1], scale.z * primaries[2]);
}

}  // namespace

bool is_rec709(const Chromaticities& chromaticities) {
  for (std::size_t i = 0; i < kRec709.size(); ++i)
    if (!(std::abs(chromaticities[i] - kRec709[i]) < kSameChromaticity)) return false;
  return true;
}

std::optional<glm::dmat3> to_rec709(const Chromaticities& chromaticities) {
  const auto from = to_xyz(chromaticities);
  if (!from) return std::nullopt;
  const glm::dvec3 gain = kBradford * white_of(kRec709) / (kBradford * white_of(chromaticities));
  const glm::dmat3 adapt =
      glm::inverse(kBradford) * glm::dmat3(gain.x, 0, 0, 0, gain.y, 0, 0, 0, gain.z) * kBradford;
  const glm::dmat3 matrix = glm::inverse(*to_xyz(kRec709)) * adapt * *from;
  for (int column = 0; column < 3; ++column)
    if (!std::isfinite(glm::dot(matrix[column], glm::dvec3(1)))) return std::nullopt;
  return matrix;
}

std::string text_of(const Chromaticities& c) {
  return fmt::format("{:.4g},{:.4g} {:.4g},{:.4g} {:.4g},{:.4g}, white {:.4g},{:.4g}", c[0], c[1],
                     c[2], c[3], c[4], c[5], c[6], c[7]);
}

}  // namespace clpv
