// SPDX-License-Identifier: MIT
// Reads and decodes the images of a glTF document.
#include <fmt/ranges.h>

#include <atomic>
#include <exception>
#include <future>
#include <map>
#include <optional>
#include <thread>

#include "image/codec.hpp"
#include "image/image_header.hpp"
#include "scene/bounds.hpp"
#include "scene/gltf_parts.hpp"
#include "support/error.hpp"

namespace clpv {
namespace {

/// An encoded image whose header is checked.
struct EncodedImage {
  std::string place, name;
  Bytes owned;                          ///< bytes of a file
  std::span<const std::uint8_t> bytes;  ///< owned, or in the document
  ImageHeader header;
};

std::string first_bytes(std::span<const std::uint8_t> bytes) {
  return fmt::format("{:02x}", fmt::join(bytes.first(std::min<std::size_t>(bytes.size(), 8)), " "));
}

void read_encoded(const GltfDocument& document, int index, EncodedImage& encoded) {
  const tinygltf::Image& image = entry(document.model.images, index);
  encoded.place = encoded.name = fmt::format("/images/{}", index);
  if (image.bufferView >= 0) {
    encoded.bytes = document.view(image.bufferView);
    return;
  }
  const std::string place = encoded.place + "/uri";
  if (is_data_uri(image.uri)) {
    encoded.owned = decode_data_uri(image.uri, document.file, place);
  } else {
    const auto path = resolve_uri(document.folder, image.uri, document.file, place);
    encoded.owned = read_file(path, bounds::kImageFileBytes, document.file, place);
    encoded.name = path.filename().string();
  }
  encoded.bytes = encoded.owned;
}

void check_encoded(const GltfDocument& document, EncodedImage& encoded) {
  const auto header = read_image_header(encoded.bytes);
  if (!header) {
    reject(document.file, encoded.place,
           fmt::format("'{}' that begins with bytes {}", encoded.name, first_bytes(encoded.bytes)),
           "a PNG, JPEG or still WebP image, whatever its name");
  }
  if (header->width == 0 || header->height == 0 || header->width > bounds::kImageSide ||
      header->height > bounds::kImageSide) {
    reject(document.file, encoded.place,
           fmt::format("'{}' of {} x {} pixels", encoded.name, header->width, header->height),
           fmt::format("1 to {} pixels per side", bounds::kImageSide));
  }
  if (!header->complete) {
    reject(document.file, encoded.place, fmt::format("'{}', truncated", encoded.name),
           "a complete image");
  }
  encoded.header = *header;
}

/// Converts pixels of 1 (grey), 2 (grey, alpha), 3 (RGB) or 4 channels (RGBA) to RGBA.
std::vector<std::uint8_t> to_rgba(const std::vector<std::uint8_t>& pixels, int channels) {
  const std::size_t count = pixels.size() / static_cast<std::size_t>(channels);
  std::vector<std::uint8_t> rgba(count * 4);
  const bool grey = channels < 3;
  for (std::size_t i = 0; i < count; ++i) {
    const std::uint8_t* from = &pixels[i * static_cast<std::size_t>(channels)];
    rgba[4 * i] = from[0];
    rgba[4 * i + 1] = from[grey ? 0 : 1];
    rgba[4 * i + 2] = from[grey ? 0 : 2];
    rgba[4 * i + 3] = channels == 2 ? from[1] : channels >= 4 ? from[3] : 255;
  }
  return rgba;
}

/// Decodes bytes of the image, stripped of unneeded chunks; sets the number of channels.
std::vector<std::uint8_t> decode(const GltfDocument& document, const EncodedImage& encoded,
                                 std::span<const std::uint8_t> bytes, std::size_t& channels) {
  const auto fail = [&](const std::string& reason) {
    reject(document.file, encoded.place,
           fmt::format("'{}', which does not decode: {}", encoded.name, reason),
           "a readable PNG, JPEG or WebP image");
  };
  const std::string format(name_of(encoded.header.format));
  std::string error;
  const auto decoder = image_codec().open(format, "memory." + format, bytes, error);
  if (!decoder) fail(error);
  const CodedImage& image = decoder->described();
  if (image.width != static_cast<int>(encoded.header.width) ||
      image.height != static_cast<int>(encoded.header.height)) {
    fail(fmt::format("{} x {} pixels in its header, {} x {} in its decoder", encoded.header.width,
                     encoded.header.height, image.width, image.height));
  }
  channels = image.channels.size();
  std::vector<std::uint8_t> pixels(static_cast<std::size_t>(image.width) *
                                   static_cast<std::size_t>(image.height) * channels);
  if (const std::string failure = decoder->read(pixels.data()); !failure.empty()) fail(failure);
  return pixels;
}

/// RGBA of an image, not multiplied by alpha.
std::vector<std::uint8_t> decode(const GltfDocument& document, const EncodedImage& encoded) {
  const auto rgba_of = [&](std::span<const std::uint8_t> bytes) {
    std::size_t channels = 0;
    std::vector<std::uint8_t> pixels = decode(document, encoded, bytes, channels);
    return channels == 4 ? pixels : to_rgba(pixels, static_cast<int>(channels));
  };
  switch (encoded.header.format) {
    case ImageFormat::png:
      return rgba_of(strip_png(encoded.bytes));
    case ImageFormat::jpeg:
      return rgba_of(encoded.bytes);
    case ImageFormat::webp:
      break;
  }
  const Bytes opaque = strip_webp(encoded.bytes, false), whole = strip_webp(encoded.bytes, true);
  std::vector<std::uint8_t> rgba = rgba_of(opaque);
  if (whole == opaque) return rgba;
  const std::vector<std::uint8_t> transparent = rgba_of(whole);
  for (std::size_t i = 3; i < rgba.size(); i += 4) rgba[i] = transparent[i];
  return rgba;
}

/// Runs `work(i)` for i in 0..count-1 on all cores. Rethrows the exception of the lowest i.
template <typename Work>
void for_all(std::size_t count, const Work& work) {
  std::vector<std::exception_ptr> failures(count);
  std::atomic<std::size_t> next{0};
  const auto worker = [&] {
    for (std::size_t i = next++; i < count; i = next++) {
      try {
        work(i);
      } catch (...) {
        failures[i] = std::current_exception();
      }
    }
  };
  std::vector<std::future<void>> workers;
  const std::size_t threads =
      std::min<std::size_t>(count, std::max(1u, std::thread::hardware_concurrency()));
  for (std::size_t i = 1; i < threads; ++i)
    workers.push_back(std::async(std::launch::async, worker));
  worker();
  for (auto& each : workers) each.get();
  for (const auto& failure : failures) {
    if (failure) std::rethrow_exception(failure);
  }
}

}  // namespace

std::vector<Texture> load_textures(const GltfDocument& document,
                                   const std::vector<TextureRequest>& requests) {
  std::map<int, std::size_t> slots;  // image -> index in `encoded`
  for (const TextureRequest& request : requests) slots.try_emplace(request.image, 0);
  std::vector<EncodedImage> encoded(slots.size());
  std::vector<int> images;
  for (auto& [image, slot] : slots) {
    slot = images.size();
    images.push_back(image);
  }
  std::uint64_t file_bytes = 0;
  for (std::size_t i = 0; i < images.size(); ++i) {
    read_encoded(document, images[i], encoded[i]);
    check_encoded(document, encoded[i]);
    file_bytes += encoded[i].owned.size();
    if (file_bytes > bounds::kBufferBytes) {
      reject(document.file, encoded[i].place,
             fmt::format("{} bytes of image files so far", file_bytes),
             fmt::format("at most {} in all", bounds::kBufferBytes));
    }
  }
  std::uint64_t texel_bytes = 0;
  for (const TextureRequest& request : requests) {
    const EncodedImage& image = encoded[slots[request.image]];
    texel_bytes += 4ull * image.header.width * image.header.height;
    if (texel_bytes > bounds::kTexelBytes) {
      reject(document.file, image.place, fmt::format("{} bytes of texels so far", texel_bytes),
             fmt::format("at most {} in all", bounds::kTexelBytes));
    }
  }
  std::vector<std::vector<std::uint8_t>> decoded(encoded.size());
  for_all(encoded.size(), [&](std::size_t i) { decoded[i] = decode(document, encoded[i]); });
  std::vector<Texture> textures;
  for (const TextureRequest& request : requests) {
    const std::size_t slot = slots[request.image];
    const ImageHeader& header = encoded[slot].header;
    textures.push_back({header.width, header.height, request.wrap_u, request.wrap_v, decoded[slot],
                        encoded[slot].name});
  }
  return textures;
}

}  // namespace clpv
