// SPDX-License-Identifier: MIT
// Reads glTF documents by tinygltf 2.7, which trusts indices and sizes, opens files of URIs, and
// decodes images. Here it reads only checked JSON, opens only buffers in the model's folder, and
// does not decode images.
#include "scene/gltf_document.hpp"

#include <nlohmann/json.hpp>

#include "scene/bounds.hpp"
#include "scene/gltf_accessor.hpp"
#include "support/error.hpp"
#include "support/input_file.hpp"
#include "support/input_record.hpp"

namespace clpv {
namespace {

using nlohmann::json;

bool is_glb(const Bytes& bytes) {
  constexpr std::uint32_t kMagic = 0x46546C67;
  return bytes.size() >= 4 && little_endian_word(bytes, 0) == kMagic;
}

/// JSON of a .glb, its first chunk. Checks the version and the header of the second chunk, which
/// tinygltf does not.
std::string_view json_of_glb(const Bytes& bytes, const std::string& file) {
  constexpr std::size_t kChunkHeader = 8, kText = 12 + kChunkHeader;
  if (bytes.size() < kText)
    reject(file, {}, fmt::format("a .glb of {} bytes", bytes.size()),
           "at least 20: it is truncated");
  if (const auto version = little_endian_word(bytes, 4); version != 2)
    reject(file, {}, fmt::format(".glb version {}", version), "version 2");
  const std::size_t length = little_endian_word(bytes, 8), size = little_endian_word(bytes, 12);
  const std::size_t end = kText + size;
  if (length > bytes.size() || end > length) {
    reject(file, {},
           fmt::format("a .glb of {} bytes, by its header {}, its first chunk {}", bytes.size(),
                       length, size),
           "chunks within the file: it is truncated");
  }
  if (end + kChunkHeader <= length &&
      end + kChunkHeader + little_endian_word(bytes, end) > length) {
    reject(file, {}, fmt::format("a second .glb chunk of {} bytes", little_endian_word(bytes, end)),
           fmt::format("at most {}, the rest of the file", length - end - kChunkHeader));
  }
  return {reinterpret_cast<const char*>(bytes.data()) + kText, size};
}

/// Buffers in files, in the order in which tinygltf opens them. After them it looks for image files
/// and finds none: load_textures reads those in use.
struct BufferFiles {
  const GltfDocument& document;
  const json& parsed;
  std::vector<std::size_t> remaining = {};  ///< indices; the next buffer is the last
  std::uint64_t bytes_left = bounds::kBufferBytes;
};

BufferFiles find_buffer_files(const GltfDocument& document, const json& parsed) {
  BufferFiles files{document, parsed};
  for (std::size_t i = parsed.contains("buffers") ? parsed["buffers"].size() : 0; i-- > 0;) {
    const json& buffer = parsed["buffers"][i];
    if (buffer.contains("uri") && !tinygltf::IsDataURI(buffer["uri"].get_ref<const std::string&>()))
      files.remaining.push_back(i);
  }
  return files;
}

bool read_next_buffer(Bytes* bytes, std::string*, const std::string&, void* user_data) {
  auto& files = *static_cast<BufferFiles*>(user_data);
  const std::size_t index = files.remaining.back();
  files.remaining.pop_back();
  const json& buffer = files.parsed["buffers"][index];
  const std::string& file = files.document.file;
  const std::string place = fmt::format("/buffers/{}", index), uri_place = place + "/uri";
  const auto path = resolve_uri(files.document.folder, buffer["uri"], file, uri_place);
  *bytes = read_file(path, files.bytes_left, file, uri_place);
  files.bytes_left -= bytes->size();
  const std::size_t length = buffer["byteLength"];
  if (bytes->size() < length) {
    reject(file, place + "/byteLength", fmt::format("{}", length),
           fmt::format("at most the {} bytes of the file: truncated?", bytes->size()));
  }
  bytes->resize(length);
  return true;
}

tinygltf::FsCallbacks callbacks(BufferFiles& files) {
  return {[](const std::string&, void* user_data) {
            return !static_cast<BufferFiles*>(user_data)->remaining.empty();
          },
          [](const std::string& path, void*) { return path; }, read_next_buffer, nullptr, &files};
}

bool keep_encoded(tinygltf::Image* image, int, std::string*, std::string*, int, int,
                  const unsigned char* bytes, int size, void*) {
  if (image->bufferView < 0) image->image.assign(bytes, bytes + size);
  return true;
}

/// JSON pointer of the entry at which tinygltf failed, in those lists, and in the order, in which
/// it can fail.
std::string place_of_failure(const tinygltf::Model& model, const json& document) {
  const std::pair<std::string, std::size_t> read[] = {
      {"/buffers", model.buffers.size()},
      {"/bufferViews", model.bufferViews.size()},
      {"/images", model.images.size()},
      {"/cameras", model.cameras.size()},
      {"/extensions/KHR_lights_punctual/lights", model.lights.size()}};
  for (const auto& [list, count] : read) {
    const json::json_pointer pointer(list);
    if (document.contains(pointer) && count < document.at(pointer).size())
      return fmt::format("{}/{}", list, count);
  }
  return {};
}

void load_model(const Bytes& bytes, const json& parsed, GltfDocument& document) {
  BufferFiles files = find_buffer_files(document, parsed);
  tinygltf::TinyGLTF loader;
  loader.SetFsCallbacks(callbacks(files));
  loader.SetImageLoader(keep_encoded, nullptr);
  std::string error, warning;
  const auto size = static_cast<unsigned>(bytes.size());
  const bool loaded =
      is_glb(bytes)
          ? loader.LoadBinaryFromMemory(&document.model, &error, &warning, bytes.data(), size)
          : loader.LoadASCIIFromString(&document.model, &error, &warning,
                                       reinterpret_cast<const char*>(bytes.data()), size, "");
  if (!loaded)
    reject(document.file, place_of_failure(document.model, parsed), excerpt(error), "glTF 2.0");
}

/// Adds all images of the document to the InputRecord: those that no material uses are not read.
void record_images(const GltfDocument& document) {
  for (std::size_t i = 0; i < document.model.images.size(); ++i) {
    const std::string& uri = document.model.images[i].uri;
    const auto path = uri.starts_with("data:") ? std::nullopt : percent_decoded(uri);
    if (path && !path->empty())
      InputRecord::add(
          {fmt::format("{} /images/{}/uri", document.file, i), document.folder / *path});
  }
}

}  // namespace

std::span<const std::uint8_t> GltfDocument::view(int index) const {
  const tinygltf::BufferView& view = entry(model.bufferViews, index);
  return std::span(entry(model.buffers, view.buffer).data)
      .subspan(view.byteOffset, view.byteLength);
}

GltfDocument read_gltf_document(const std::filesystem::path& path) {
  GltfDocument document;
  document.file = path.string();
  const Bytes bytes = read_file(path, bounds::kGlbBytes, document.file);
  document.folder = std::filesystem::canonical(path).parent_path();
  const std::string_view text =
      is_glb(bytes) ? json_of_glb(bytes, document.file)
                    : std::string_view(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  const json parsed = parse_json(text, document.file);
  check_gltf(parsed, document.file);
  load_model(bytes, parsed, document);
  record_images(document);
  check_accessors(document);
  return document;
}

}  // namespace clpv
