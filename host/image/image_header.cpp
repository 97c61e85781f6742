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

bool starts_with(Data bytes, Data prefix) {
  return bytes.size() >= prefix.size() && std::equal(prefix.begin(), prefix.end(), bytes.begin());
}

bool contains(Data bytes, Data sequence) {
  return std::search(bytes.begin(), bytes.end(), sequence.begin(), sequence.end()) != bytes.end();
}

constexpr std::size_t kPngSignature = 8;

constexpr std::size_t kChunkData = 8, kChunkCheck = 4;  // bytes before and after a chunk's data

/// Calls `visit(type, chunk)` for each chunk of a PNG up to IEND. Returns false if a chunk exceeds
/// the bytes.
template <typename Visit>
bool visit_chunks(Data bytes, const Visit& visit) {
  // Length and type before a chunk's data, checksum after them.
  constexpr std::size_t kOverhead = 12;
  for (std::size_t at = kPngSignature; bytes.size() - at >= kOverhead;) {
    const std::size_t length = big_endian(bytes, at, 4);
    if (length > bytes.size() - at - kOverhead) return false;
    const Data chunk = bytes.subspan(at, kOverhead + length);
    const std::string_view type(reinterpret_cast<const char*>(chunk.data()) + 4, 4);
    visit(type, chunk);
    if (type == "IEND") return true;
    at += chunk.size();
  }
  return false;
}

std::optional<ImageHeader> png_header(Data bytes) {
  // Signature, then the IHDR chunk.
  constexpr std::size_t kWidth = 16, kHeight = 20, kHeaderEnd = 33;
  constexpr std::array<std::uint8_t, 4> kHeaderType = {'I', 'H', 'D', 'R'};
  if (bytes.size() < kHeaderEnd || !starts_with(bytes.subspan(12), kHeaderType))
    return std::nullopt;
  return ImageHeader{ImageFormat::png, big_endian(bytes, kWidth, 4), big_endian(bytes, kHeight, 4),
                     visit_chunks(bytes, [](std::string_view, Data) {})};
}

std::optional<ImageHeader> jpeg_header(Data bytes) {
  constexpr std::array<std::uint8_t, 2> kEnd = {0xff, 0xd9};
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
                         big_endian(bytes, at + 5, 2), contains(bytes.subspan(at), kEnd)};
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
    const std::string_view type(reinterpret_cast<const char*>(bytes.data()) + at, 4);
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
  constexpr std::array<std::uint8_t, 3> kLossyStart = {0x9d, 0x01, 0x2a};
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
  if (!starts_with(image.subspan(kRiffChunkHeader + 3), kLossyStart)) return std::nullopt;
  return ImageHeader{ImageFormat::webp, little_endian(image, kRiffChunkHeader + 6, 2) & kSide,
                     little_endian(image, kRiffChunkHeader + 8, 2) & kSide, chunks.complete};
}

void append_little_endian(std::vector<std::uint8_t>& to, std::uint32_t value, std::size_t size) {
  for (std::size_t i = 0; i < size; ++i) to.push_back(static_cast<std::uint8_t>(value >> 8 * i));
}

void append_chunk(std::vector<std::uint8_t>& to, Data chunk) {
  to.insert(to.end(), chunk.begin(), chunk.end());
  if (chunk.size() % 2 != 0) to.push_back(0);
}

}  // namespace

std::optional<ImageHeader> read_image_header(Data bytes) {
  constexpr std::array<std::uint8_t, 8> kPng = {0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n'};
  constexpr std::array<std::uint8_t, 3> kJpeg = {0xff, 0xd8, 0xff};
  if (starts_with(bytes, kPng)) return png_header(bytes);
  if (starts_with(bytes, kJpeg)) return jpeg_header(bytes);
  constexpr std::array<std::uint8_t, 4> kRiff = {'R', 'I', 'F', 'F'}, kWebp = {'W', 'E', 'B', 'P'};
  if (bytes.size() >= kRiffHeader && starts_with(bytes, kRiff) &&
      starts_with(bytes.subspan(8), kWebp))
    return webp_header(bytes);
  return std::nullopt;
}

std::vector<std::uint8_t> strip_png(Data bytes) {
  constexpr std::array<std::string_view, 6> kKept = {"IHDR", "PLTE", "tRNS",
                                                     "tEXt", "IDAT", "IEND"};
  std::vector<std::uint8_t> kept(bytes.begin(), bytes.begin() + kPngSignature);
  visit_chunks(bytes, [&](std::string_view type, Data chunk) {
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
  visit_chunks(png, [&](std::string_view type, Data chunk) {
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
  std::vector<std::uint8_t> kept;
  const auto append_text = [&kept](std::string_view text) {
    kept.insert(kept.end(), text.begin(), text.end());
  };
  append_text("RIFF");
  append_little_endian(kept, 0, 4);  // size, set below
  append_text("WEBP");
  if (alpha && !chunks.lossless() && !chunks.alpha.empty()) {
    append_text("VP8X");
    append_little_endian(kept, 10, 4);
    append_little_endian(kept, kWebpAlpha, 4);
    append_little_endian(kept, header.width - 1, 3);
    append_little_endian(kept, header.height - 1, 3);
    append_chunk(kept, chunks.alpha);
  }
  const std::size_t image = kept.size();
  append_chunk(kept, chunks.image);
  if (!alpha && chunks.lossless())
    kept[image + kRiffChunkHeader + 4] &= static_cast<std::uint8_t>(~(kLosslessAlpha >> 24));
  for (std::size_t i = 0; i < 4; ++i)
    kept[4 + i] = static_cast<std::uint8_t>((kept.size() - kRiffChunkHeader) >> 8 * i);
  return kept;
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
