// SPDX-License-Identifier: MIT
// Reads a glTF file: container, JSON, checks, buffers; then lets tinygltf make typed structs of the rest.
//
// tinygltf 2.7 reads files and decodes images as it parses, and trusts counts and indices. It is therefore
// handed a document that has been checked and that names neither buffers nor images.
#include "scene/gltf_document.hpp"

#include <algorithm>
#include <cstring>
#include <nlohmann/json.hpp>

#include "scene/bounds.hpp"
#include "scene/gltf_schema.hpp"
#include "support/error.hpp"
#include "support/input_file.hpp"

namespace clpv {
namespace {

using nlohmann::json;

struct Container {
  std::string_view text;                                ///< the JSON
  std::optional<std::span<const std::uint8_t>> binary;  ///< a .glb's binary chunk
};

constexpr std::uint32_t kGlbMagic = 0x46546C67, kJsonChunk = 0x4E4F534A, kBinaryChunk = 0x004E4942;

Container open_glb(const Bytes& bytes, const std::string& file) {
  constexpr std::size_t kHeader = 12, kChunkHeader = 8;
  if (bytes.size() < kHeader + kChunkHeader) {
    refuse(file, {}, fmt::format("a .glb of {} bytes", bytes.size()), "at least 20: it is truncated");
  }
  if (little_endian_word(bytes, 4) != 2)
    refuse(file, {}, fmt::format(".glb version {}", little_endian_word(bytes, 4)), "version 2");
  const std::size_t length = little_endian_word(bytes, 8);
  if (length > bytes.size() || length < kHeader + kChunkHeader) {
    refuse(file, {}, fmt::format("a .glb of {} bytes whose header says {}", bytes.size(), length),
           "the length in the header: it is truncated");
  }
  Container container;
  for (std::size_t offset = kHeader; offset + kChunkHeader <= length;) {
    const std::size_t size = little_endian_word(bytes, offset);
    const std::uint32_t type = little_endian_word(bytes, offset + 4);
    const std::size_t start = offset + kChunkHeader;
    if (size > length - start) {
      refuse(file, {}, fmt::format("a .glb chunk of {} bytes at byte {}", size, offset),
             fmt::format("at most {}, what is left of the file", length - start));
    }
    if (offset == kHeader && type != kJsonChunk) {
      refuse(file, {}, fmt::format("first .glb chunk of type {:#x}", type), "JSON (0x4e4f534a)");
    }
    if (type == kJsonChunk && offset == kHeader) {
      if (size > bounds::kJsonBytes) {
        refuse(file, {}, fmt::format("{} bytes of JSON", size),
               fmt::format("at most {}", bounds::kJsonBytes));
      }
      container.text = {reinterpret_cast<const char*>(bytes.data()) + start, size};
    } else if (type == kBinaryChunk && !container.binary) {
      container.binary = std::span(bytes).subspan(start, size);
    }
    offset = start + (size + 3) / 4 * 4;
  }
  return container;
}

Container open_container(const Bytes& bytes, const std::string& file) {
  if (bytes.size() >= 4 && little_endian_word(bytes, 0) == kGlbMagic) return open_glb(bytes, file);
  if (bytes.size() > bounds::kJsonBytes) {
    refuse(file, {}, fmt::format("{} bytes of JSON", bytes.size()),
           fmt::format("at most {}", bounds::kJsonBytes));
  }
  return {{reinterpret_cast<const char*>(bytes.data()), bytes.size()}, std::nullopt};
}

Bytes read_buffer(const json& buffer, const Container& container, const GltfDocument& document,
                  std::size_t index, std::uint64_t left) {
  const std::string place = fmt::format("/buffers/{}", index);
  if (!buffer.contains("uri")) {
    if (index != 0 || !container.binary) {
      refuse(document.file, place, "no uri", "a uri, but for the first buffer of a .glb with a binary chunk");
    }
    return Bytes(container.binary->begin(), container.binary->end());
  }
  const std::string& uri = buffer["uri"].get_ref<const std::string&>();
  if (uri.starts_with("data:")) return decode_data_uri(uri, document.file, place + "/uri");
  return read_file(resolve_uri(document.folder, uri, document.file, place + "/uri"), left, document.file,
                   place + "/uri");
}

void read_buffers(const json& parsed, const Container& container, GltfDocument& document) {
  if (!parsed.contains("buffers")) return;
  std::uint64_t left = bounds::kBufferBytes;
  for (std::size_t i = 0; i < parsed["buffers"].size(); ++i) {
    const json& buffer = parsed["buffers"][i];
    Bytes bytes = read_buffer(buffer, container, document, i, left);
    const std::uint64_t wanted = buffer["byteLength"];
    if (bytes.size() < wanted || bytes.size() > left) {
      refuse(document.file, fmt::format("/buffers/{}/byteLength", i), fmt::format("{}", wanted),
             bytes.size() > left
                 ? fmt::format("{} bytes left of {} for all buffers", left, bounds::kBufferBytes)
                 : fmt::format("at most the {} bytes there are: truncated?", bytes.size()));
    }
    left -= bytes.size();
    document.buffers.push_back(std::move(bytes));
  }
}

void read_image_places(const json& parsed, GltfDocument& document) {
  if (!parsed.contains("images")) return;
  for (const json& image : parsed["images"]) {
    GltfImage place{image.value("uri", std::string()), std::nullopt};
    if (image.contains("bufferView")) place.buffer_view = image["bufferView"].get<std::size_t>();
    document.images.push_back(std::move(place));
  }
}

/// Hands tinygltf what it is to make structs of.
void parse_model(json parsed, GltfDocument& document) {
  for (const char* unread : {"buffers", "images", "animations", "extras"}) parsed.erase(unread);
  const std::string text = parsed.dump();
  tinygltf::TinyGLTF parser;
  std::string error, warning;
  if (!parser.LoadASCIIFromString(&document.model, &error, &warning, text.data(),
                                  static_cast<unsigned int>(text.size()), "", tinygltf::REQUIRE_VERSION)) {
    std::replace(error.begin(), error.end(), '\n', ' ');
    refuse(document.file, {}, "no glTF: " + error, "glTF 2.0");
  }
}

}  // namespace

std::span<const std::uint8_t> GltfDocument::view(std::size_t index) const {
  const tinygltf::BufferView& view = model.bufferViews[index];
  return std::span(buffers[static_cast<std::size_t>(view.buffer)]).subspan(view.byteOffset, view.byteLength);
}

GltfDocument read_gltf_document(const std::filesystem::path& path) {
  GltfDocument document;
  document.file = path.string();
  const Bytes bytes = read_file(path, bounds::kGlbBytes, document.file);
  document.folder = std::filesystem::canonical(path).parent_path();
  const Container container = open_container(bytes, document.file);
  json parsed = parse_json(container.text, document.file);
  check_gltf(parsed, document.file);
  read_buffers(parsed, container, document);
  read_image_places(parsed, document);
  for (const std::string name : parsed.value("extensionsUsed", json::array())) {
    if (!reads_extension(name)) document.ignored_extensions.push_back(name);
  }
  if (parsed.contains("animations"))
    document.animations = std::make_shared<const json>(std::move(parsed["animations"]));
  parse_model(std::move(parsed), document);
  return document;
}

Bytes decode_data_uri(const std::string& uri, const std::string& file, std::string_view place) {
  Bytes bytes;
  std::string mime_type;
  if (!tinygltf::DecodeDataURI(&bytes, mime_type, uri, 0, false)) {
    refuse(file, place, "'" + uri.substr(0, 40) + "...'", "a base64 data URI of octets, PNG or JPEG");
  }
  return bytes;
}

}  // namespace clpv
