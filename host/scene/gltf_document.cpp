// SPDX-License-Identifier: MIT
// Reads glTF documents by tinygltf (2.7 and 2.9), which trusts indices and sizes, opens files of
// URIs, knows six spellings of data URIs, and decodes images. Here it reads only checked JSON,
// whose buffers come from this file: it neither opens files nor decodes images.
#include "scene/gltf_document.hpp"

#include <nlohmann/json.hpp>
#include <set>

#include "scene/bounds.hpp"
#include "scene/gltf_accessor.hpp"
#include "support/array_files.hpp"
#include "support/error.hpp"
#include "support/input_file.hpp"

namespace clpv {
namespace {

using nlohmann::json;

/// The document's JSON, and the binary chunk of a .glb.
struct Container {
  std::string_view json;
  std::span<const std::uint8_t> binary = {};
};

/// Chunks of a .glb (glTF 2.0, section 4.4): JSON, then an optional binary one; others are ignored.
Container chunks_of_glb(const Bytes& bytes, const std::string& file) {
  constexpr std::size_t kChunkHeader = 8, kText = 12 + kChunkHeader;
  constexpr std::uint32_t kJson = 0x4E4F534A, kBinary = 0x004E4942;
  if (bytes.size() < kText)
    reject(file, {}, fmt::format("a .glb of {} bytes", bytes.size()),
           "at least 20: it is truncated");
  if (const auto version = little_endian(bytes, 4); version != 2)
    reject(file, {}, fmt::format(".glb version {}", version), "version 2");
  const std::size_t length = little_endian(bytes, 8), size = little_endian(bytes, 12);
  const std::size_t end = kText + size;
  if (length > bytes.size() || end > length) {
    reject(file, {},
           fmt::format("a .glb of {} bytes, by its header {}, its first chunk {}", bytes.size(),
                       length, size),
           "chunks within the file: it is truncated");
  }
  if (const auto type = little_endian(bytes, 16); type != kJson)
    reject(file, {}, fmt::format("a first .glb chunk of type {:#x}", type), "JSON, 0x4e4f534a");
  Container chunks{{reinterpret_cast<const char*>(bytes.data()) + kText, size}};
  if (end + kChunkHeader > length) return chunks;
  const std::size_t second = little_endian(bytes, end);
  if (end + kChunkHeader + second > length) {
    reject(file, {}, fmt::format("a second .glb chunk of {} bytes", second),
           fmt::format("at most {}, the rest of the file", length - end - kChunkHeader));
  }
  if (little_endian(bytes, end + 4) == kBinary)
    chunks.binary = std::span(bytes).subspan(end + kChunkHeader, second);
  return chunks;
}

/// Takes the URIs out of a list of the document, where placeholders stay.
std::vector<std::string> take_uris(json& document, const char* list) {
  std::vector<std::string> uris;
  if (!document.contains(list)) return uris;
  for (json& each : document[list]) {
    std::string& uri = uris.emplace_back();
    if (!each.contains("uri")) continue;
    uri = std::move(each["uri"].get_ref<std::string&>());
    each["uri"] = "-";
  }
  return uris;
}

/// Reads the bytes of buffers, in the order in which tinygltf asks for them. After them it looks
/// for files of images and finds none: load_textures reads those in use.
class BufferReader {
 public:
  BufferReader(const GltfDocument& document, const json& parsed,
               const std::vector<std::string>& uris, std::span<const std::uint8_t> binary)
      : document_(document), parsed_(parsed), uris_(uris), binary_(binary) {}

  bool done() const { return next_ == uris_.size(); }

  Bytes read_next() {
    const std::size_t index = next_++;
    const std::string& file = document_.file;
    const std::string place = fmt::format("/buffers/{}", index);
    auto [bytes, source] = content(uris_[index], place);
    const std::size_t length = parsed_["buffers"][index]["byteLength"];
    if (bytes.size() < length) {
      reject(file, place + "/byteLength", fmt::format("{}", length),
             fmt::format("at most the {} bytes of {}: truncated?", bytes.size(), source));
    }
    bytes_left_ -= bytes.size();
    bytes.resize(length);
    return std::move(bytes);
  }

 private:
  struct Content {
    Bytes bytes;
    const char* source;
  };

  Content content(const std::string& uri, const std::string& place) const {
    const std::string& file = document_.file;
    const std::string uri_place = place + "/uri";
    if (uri.empty()) {
      if (binary_.empty()) reject(file, place, "no uri", "a uri, or the binary chunk of a .glb");
      return {Bytes(binary_.begin(), binary_.end()), "the binary chunk"};
    }
    if (is_data_uri(uri)) return {decode_data_uri(uri, file, uri_place), "the URI"};
    const auto path = resolve_uri(document_.folder, uri, file, uri_place);
    return {read_file(path, bytes_left_, file, uri_place), "the file"};
  }

  const GltfDocument& document_;
  const json& parsed_;
  const std::vector<std::string>& uris_;
  std::span<const std::uint8_t> binary_;
  std::size_t next_ = 0;
  std::uint64_t bytes_left_ = bounds::kBufferBytes;
};

/// A template, since tinygltf 2.9 has a callback more, and requires all.
template <typename Callbacks = tinygltf::FsCallbacks>
Callbacks callbacks(BufferReader& reader) {
  Callbacks made{};
  made.FileExists = [](const std::string&, void* user_data) {
    return !static_cast<BufferReader*>(user_data)->done();
  };
  made.ExpandFilePath = [](const std::string& path, void*) { return path; };
  made.ReadWholeFile = [](Bytes* bytes, std::string*, const std::string&, void* user_data) {
    *bytes = static_cast<BufferReader*>(user_data)->read_next();
    return true;
  };
  made.WriteWholeFile = [](auto...) { return false; };
  if constexpr (requires { made.GetFileSizeInBytes; }) {
    made.GetFileSizeInBytes = [](std::size_t* bytes, auto...) {
      *bytes = 0;  // read_next() checks sizes
      return true;
    };
  }
  made.user_data = &reader;
  return made;
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

/// Throws Error(bad_input) for a node with a matrix and a translation, rotation or scale (glTF 2.0,
/// 3.5.3): tinygltf drops one of the two.
void check_transforms(const json& document, const std::string& file) {
  if (!document.contains("nodes")) return;
  for (std::size_t i = 0; i < document["nodes"].size(); ++i) {
    const json& node = document["nodes"][i];
    const bool parts =
        node.contains("translation") || node.contains("rotation") || node.contains("scale");
    if (parts && node.contains("matrix"))
      reject(file, fmt::format("/nodes/{}", i), "a matrix, and a translation, rotation or scale",
             "one of the two");
  }
}

/// Finds the names of the extensions of all objects in the document, and that of an animated
/// pointer, also without its object.
void find_extensions(const json& value, std::set<std::string>& names) {
  if (value.is_array()) {
    for (const json& each : value) find_extensions(each, names);
  } else if (value.is_object()) {
    for (const auto& [key, member] : value.items()) {
      if (key == "extensions" && member.is_object()) {
        for (const auto& [name, extension] : member.items()) names.insert(name);
      }
      if (key == "path" && member == "pointer") names.insert("KHR_animation_pointer");
      if (key != "extras") find_extensions(member, names);
    }
  }
}

/// Gives a document what tinygltf requires and glTF, or common exporters, do not, and
/// extensionsUsed the extensions that it lacks.
void complete(json& document) {
  std::set<std::string> found;
  find_extensions(document, found);
  json& used = document["extensionsUsed"];
  for (const json& listed : used) found.erase(listed.get_ref<const std::string&>());
  for (const std::string& name : found) used.push_back(name);
  if (used.is_null()) used = json::array();
  const json::json_pointer lights("/extensions/KHR_lights_punctual/lights");
  if (!document.contains(lights)) return;
  for (json& light : document.at(lights)) {
    if (light["type"] == "spot" && !light.contains("spot")) light["spot"] = json::object();
  }
}

void load_model(json& parsed, std::span<const std::uint8_t> binary, GltfDocument& document) {
  std::vector<std::string> buffers = take_uris(parsed, "buffers"),
                           images = take_uris(parsed, "images");
  if (parsed.contains("buffers")) {
    for (json& buffer : parsed["buffers"]) buffer["uri"] = "-";
  }
  complete(parsed);
  BufferReader reader(document, parsed, buffers, binary);
  tinygltf::TinyGLTF loader;
  loader.SetFsCallbacks(callbacks(reader));
  loader.SetImageLoader([](auto...) { return true; }, nullptr);
  std::string error, warning;
  const std::string text = parsed.dump();
  if (!loader.LoadASCIIFromString(&document.model, &error, &warning, text.data(),
                                  static_cast<unsigned>(text.size()), ""))
    reject(document.file, place_of_failure(document.model, parsed), excerpt(error), "glTF 2.0");
  for (std::size_t i = 0; i < buffers.size(); ++i)
    document.model.buffers[i].uri = std::move(buffers[i]);
  for (std::size_t i = 0; i < images.size(); ++i)
    document.model.images[i].uri = std::move(images[i]);
}

/// Adds all images of the document to the InputRecord: those that no material uses are not read.
void record_images(const GltfDocument& document) {
  for (std::size_t i = 0; i < document.model.images.size(); ++i) {
    const std::string& uri = document.model.images[i].uri;
    const auto path = is_data_uri(uri) ? std::nullopt : percent_decoded(uri);
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
  Container container{{reinterpret_cast<const char*>(bytes.data()), bytes.size()}};
  if (container.json.starts_with("glTF")) container = chunks_of_glb(bytes, document.file);
  json parsed = parse_json(container.json, document.file);
  check_gltf(parsed, document.file);
  check_transforms(parsed, document.file);
  load_model(parsed, container.binary, document);
  record_images(document);
  check_accessors(document);
  return document;
}

}  // namespace clpv
