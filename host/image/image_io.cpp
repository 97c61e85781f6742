// SPDX-License-Identifier: MIT
// Image files, with checks of format and size before decoding.
#include "image/image_io.hpp"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "image/image_header.hpp"
#include "support/error.hpp"
#include "support/input_file.hpp"
#include "support/output_file.hpp"
#include "support/text.hpp"

namespace clpv {
namespace {

namespace fs = std::filesystem;

// Maximum edge of a tile in a smaller image. Tiles are decoded whole: 65535 x 65535 pixels would
// take 20 s.
constexpr std::int64_t kMaxTile = 1024;

/// Format by the first bytes: "openexr", "png", "hdr" or empty.
std::string format_of_content(const std::vector<unsigned char>& bytes) {
  const std::string_view head(reinterpret_cast<const char*>(bytes.data()),
                              std::min<std::size_t>(bytes.size(), 16));
  if (head.starts_with("\x76\x2f\x31\x01")) return "openexr";
  if (head.starts_with("\x89PNG\r\n\x1a\n")) return "png";
  if (head.starts_with("#?RADIANCE") || head.starts_with("#?RGBE")) return "hdr";
  return {};
}

/// Format by the extension: "openexr", "png", "hdr" or empty.
std::string format_of_name(const fs::path& path) {
  const std::string extension = lower_extension(path);
  if (extension == ".exr") return "openexr";
  if (extension == ".png") return "png";
  if (extension == ".hdr") return "hdr";
  return {};
}

/// Returns the format of a file whose extension and content agree.
std::string checked_format(const fs::path& path, const std::vector<unsigned char>& bytes) {
  std::string by_name = format_of_name(path);
  const std::string by_content = format_of_content(bytes);
  if (by_name.empty()) {
    reject_image(
        path, fmt::format("extension '{}'; allowed: .exr, .png, .hdr", path.extension().string()));
  }
  if (by_content != by_name) {
    reject_image(path, fmt::format("content is {}; allowed: {}, as the extension says",
                                   by_content.empty() ? "of unknown format" : by_content, by_name));
  }
  return by_name;
}

/// Returns a PNG with only the chunks that its pixels need. Rejects one that is damaged or too
/// large.
Bytes stripped_png(const fs::path& path, const Bytes& bytes, const ImageLimits& limits) {
  const auto header = read_image_header(bytes);
  if (!header || !header->complete)
    reject_image(path, "damaged or truncated: a PNG chunk exceeds the file");
  check_size(path, {.width = header->width, .height = header->height, .channels = 1}, limits);
  return strip_png(bytes);
}

Image decode_png(const fs::path& path, const Bytes& bytes, const ImageLimits& limits) {
  const Bytes stripped = stripped_png(path, bytes, limits);
  const auto decoder = open_decoder(path, "png", stripped, limits);
  const CodedImage& described = decoder->described();
  Image image = make_image(described.width, described.height, described.channels);
  image.metadata = described.metadata;
  image.encoding = Encoding::srgb;
  if (const std::string colour = foreign_colour(bytes); !colour.empty())
    image.notes.push_back(fmt::format("{}: not read; values are taken as sRGB", colour));
  read_pixels(path, *decoder, image.pixels.data());
  return image;
}

Image decoded(const fs::path& path, const Bytes& bytes, const ImageLimits& limits) {
  const std::string format = checked_format(path, bytes);
  if (format == "hdr") return decode_hdr(path, bytes, limits);
  if (format == "png") return decode_png(path, bytes, limits);
  return ExrFile(path, bytes, limits).decode();
}

CodedImage coded(const Image& image) {
  return {.width = image.width,
          .height = image.height,
          .channels = image.channels,
          .metadata = image.metadata};
}

/// Throws Error(run_time) if there is an error of encoding `name`.
void require_encoded(const std::string& name, const std::string& error) {
  if (!error.empty()) throw Error(ExitCode::run_time, "{}: cannot be encoded: {}", name, error);
}

}  // namespace

void reject_image(const fs::path& path, const std::string& reason) {
  throw Error(ExitCode::bad_input, "{}: {}", path.string(), reason);
}

void check_size(const fs::path& path, const DeclaredImage& image, const ImageLimits& limits) {
  if (image.width < 1 || image.height < 1 || image.width > limits.side ||
      image.height > limits.side) {
    reject_image(path, fmt::format("{} x {} pixels; allowed: 1 to {} per side", image.width,
                                   image.height, limits.side));
  }
  if (image.channels < 1 || image.channels > limits.channels) {
    reject_image(path,
                 fmt::format("{} channels; allowed: 1 to {}", image.channels, limits.channels));
  }
  const std::int64_t max_tile = std::max({image.width, image.height, kMaxTile});
  if (image.tiled && (image.chunk_width > max_tile || image.chunk_height > max_tile)) {
    reject_image(
        path,
        fmt::format("tiles of {} x {} pixels in an image of {} x {}; allowed: up to {} per side",
                    image.chunk_width, image.chunk_height, image.width, image.height, max_tile));
  }
  if (image.deep) reject_image(path, "deep image or volume; allowed: flat images");
  const auto check_bytes = [&](const char* prefix, std::int64_t width, std::int64_t height) {
    const auto bytes = static_cast<std::size_t>(width * height * image.channels) * sizeof(float);
    if (bytes <= limits.pixel_bytes) return;
    reject_image(
        path,
        fmt::format("{}{} x {} pixels with {} channels, {} MiB; allowed: up to {} MiB", prefix,
                    width, height, image.channels, bytes >> 20, limits.pixel_bytes >> 20));
  };
  check_bytes("", image.width, image.height);
  check_bytes(image.tiled ? "tiles of " : "chunks of ", image.chunk_width, image.chunk_height);
}

void check_declared(const fs::path& path, const CodedImage& image, const ImageLimits& limits) {
  const bool tiled = image.tile_width > 0;
  check_size(path,
             {.width = image.width,
              .height = image.height,
              .chunk_width = tiled ? image.tile_width : image.width,
              .chunk_height = tiled ? image.tile_height : 1,
              .channels = static_cast<int>(image.channels.size()),
              .tiled = tiled,
              .deep = image.deep},
             limits);
}

std::unique_ptr<ImageDecoder> open_decoder(const fs::path& path, const std::string& format,
                                           std::span<const std::uint8_t> bytes,
                                           const ImageLimits& limits) {
  std::string error;
  auto decoder = image_codec().open(format, path.string(), bytes, error);
  if (!decoder) reject_image(path, "cannot be read: " + error);
  check_declared(path, decoder->described(), limits);
  return decoder;
}

void read_pixels(const fs::path& path, ImageDecoder& decoder, float* pixels) {
  if (const std::string error = decoder.read(pixels); !error.empty())
    reject_image(path, "damaged or truncated: " + error);
}

Image read_image(const fs::path& path, const ImageLimits& limits) {
  return decoded(path, read_file(path, limits.file_bytes, path.string()), limits);
}

Image decode_image(const fs::path& path, std::string_view bytes) {
  return decoded(path, Bytes(bytes.begin(), bytes.end()), {});
}

std::map<std::string, std::string> read_metadata(const fs::path& path, const ImageLimits& limits) {
  const Bytes bytes = read_file(path, limits.file_bytes, path.string());
  const std::string format = checked_format(path, bytes);
  if (format == "openexr") return ExrFile(path, bytes, limits).metadata();
  if (format != "png") return {};
  const Bytes stripped = stripped_png(path, bytes, limits);
  return open_decoder(path, format, stripped, limits)->described().metadata;
}

std::vector<unsigned char> exr_bytes(const Image& image) {
  std::vector<unsigned char> bytes;
  require_encoded("image.exr", image_codec().encode_exr(coded(image), image.pixels.data(), bytes));
  return bytes;
}

void write_exr(const fs::path& path, const Image& image) {
  const auto bytes = exr_bytes(image);
  write_file(path, std::as_bytes(std::span(bytes)));
}

std::vector<unsigned char> png_bytes(const Image& image) {
  const std::size_t channels = image.channels.size();
  if (image.encoding != Encoding::srgb || channels < 3 || channels > 4) {
    throw std::logic_error("PNG: needs sRGB-encoded R, G, B and optionally A");
  }
  std::vector<std::uint8_t> pixels(image.pixels.size());
  std::transform(image.pixels.begin(), image.pixels.end(), pixels.begin(), byte_of);
  std::vector<unsigned char> bytes;
  require_encoded("image.png", image_codec().encode_png(coded(image), pixels.data(), bytes));
  return bytes;
}

void write_png(const fs::path& path, const Image& image) {
  const auto bytes = png_bytes(image);
  write_file(path, std::as_bytes(std::span(bytes)));
}

std::map<std::string, std::string> metadata_of(const nlohmann::json& described) {
  std::map<std::string, std::string> metadata;
  for (const auto& [name, value] : described.items())
    metadata[name] = value.is_string() ? value.get<std::string>() : value.dump();
  for (const char* file : {"scene", "model", "centres"}) {
    if (const auto found = metadata.find(file); found != metadata.end())
      found->second = fs::path(found->second).filename().string();
  }
  return metadata;
}

}  // namespace clpv
