// SPDX-License-Identifier: MIT
// Reads and decodes the images of a glTF document.

#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <exception>
#include <future>
#include <map>
#include <optional>
#include <thread>

#include "image/codec.hpp"
#include "image/image_header.hpp"
#include "scene/bounds.hpp"
#include "scene/emission.hpp"
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

// Reads materials. Metals reflect their base colour diffusely, unlike in glTF, as light propagation
// volumes carry diffuse light only. Metalness, roughness, specular and normal maps are not read.

namespace {

constexpr double kStopped = 0.5;  // least share of light that a surface stops; less is a hole
constexpr float kHoleCutoff = 2;  // above any alpha: light passes everywhere
constexpr const char* kTransmission = "KHR_materials_transmission";

using tinygltf::Value;

double number_in(const Value& object, const char* key, double fallback) {
  return object.Has(key) ? object.Get(key).GetNumberAsDouble() : fallback;
}

glm::dvec2 pair_in(const Value& object, const char* key, glm::dvec2 fallback) {
  if (!object.Has(key)) return fallback;
  return {object.Get(key).Get(0).GetNumberAsDouble(), object.Get(key).Get(1).GetNumberAsDouble()};
}

/// Texture coordinates by KHR_texture_transform: scale, then rotation, then offset. The rotation is
/// counter-clockwise with v pointing down (KhronosGroup/glTF issue 1563), so u turns towards -v.
UvMapping mapping_of(int set, const tinygltf::ExtensionMap& extensions) {
  UvMapping mapping{set};
  const auto found = extensions.find("KHR_texture_transform");
  if (found == extensions.end()) return mapping;
  const Value& given = found->second;
  const glm::dvec2 offset = pair_in(given, "offset", {0, 0}),
                   scale = pair_in(given, "scale", {1, 1});
  const double angle = number_in(given, "rotation", 0), c = std::cos(angle), s = std::sin(angle);
  mapping.transform =
      glm::dmat3(c * scale.x, -s * scale.x, 0, s * scale.y, c * scale.y, 0, offset.x, offset.y, 1);
  mapping.set = static_cast<int>(number_in(given, "texCoord", set));
  return mapping;
}

std::uint32_t wrap_of(int gltf) {
  return gltf == TINYGLTF_TEXTURE_WRAP_CLAMP_TO_EDGE     ? CLPV_WRAP_CLAMP
         : gltf == TINYGLTF_TEXTURE_WRAP_MIRRORED_REPEAT ? CLPV_WRAP_MIRROR
                                                         : CLPV_WRAP_REPEAT;
}

/// Image of a texture: its own, which every reader knows, else a WebP. Without one, adds a note
/// that names the extension that has it.
std::optional<int> image_of(int texture, const GltfDocument& document, Notes& notes) {
  const tinygltf::Texture& source = entry(document.model.textures, texture);
  if (source.source >= 0) return source.source;
  const auto webp = source.extensions.find("EXT_texture_webp");
  if (webp != source.extensions.end() && webp->second.Has("source"))
    return webp->second.Get("source").GetNumberAsInt();
  std::vector<std::string> names;
  for (const auto& [name, value] : source.extensions) names.push_back(name);
  notes.add(fmt::format("/textures/{} {}: the material's factor alone is used", texture,
                        names.empty() ? std::string("has no source")
                                      : fmt::format("has an image by {} alone, which is not read",
                                                    fmt::join(names, ", "))));
  return std::nullopt;
}

/// Index of a texture in the set; the first use adds it. CLPV_NO_TEXTURE without an image to read.
std::uint32_t request(int texture, const GltfDocument& document, MaterialSet& set, Notes& notes) {
  const tinygltf::Texture& source = entry(document.model.textures, texture);
  const std::optional<int> image = image_of(texture, document, notes);
  if (!image) return CLPV_NO_TEXTURE;
  TextureRequest requested{*image, CLPV_WRAP_REPEAT, CLPV_WRAP_REPEAT};
  if (source.sampler >= 0) {
    const tinygltf::Sampler& sampler = entry(document.model.samplers, source.sampler);
    requested.wrap_u = wrap_of(sampler.wrapS);
    requested.wrap_v = wrap_of(sampler.wrapT);
  }
  const auto found = std::find(set.textures.begin(), set.textures.end(), requested);
  const auto index = static_cast<std::uint32_t>(found - set.textures.begin());
  if (found != set.textures.end()) return index;
  if (index == bounds::kTextures) {
    reject(document.file, fmt::format("/textures/{}", texture), "one more texture in use",
           fmt::format("at most {}", bounds::kTextures));
  }
  set.textures.push_back(requested);
  return index;
}

/// Colour that a surface reflects diffusely: a factor and a texture.
struct BaseColour {
  std::array<double, 4> factor;
  int texture = -1;
  UvMapping mapping;
};

/// The diffuse colour of KHR_materials_pbrSpecularGlossiness where a material has it, else glTF's
/// base colour.
BaseColour base_colour_of(const tinygltf::Material& source) {
  const auto found = source.extensions.find("KHR_materials_pbrSpecularGlossiness");
  BaseColour made;
  if (found == source.extensions.end()) {
    const auto& pbr = source.pbrMetallicRoughness;
    std::copy_n(pbr.baseColorFactor.begin(), 4, made.factor.begin());
    made.texture = pbr.baseColorTexture.index;
    made.mapping = mapping_of(pbr.baseColorTexture.texCoord, pbr.baseColorTexture.extensions);
    return made;
  }
  const Value& given = found->second;
  made.factor.fill(1);
  for (std::size_t i = 0; i < 4 && given.Has("diffuseFactor"); ++i)
    made.factor[i] = given.Get("diffuseFactor").Get(i).GetNumberAsDouble();
  if (!given.Has("diffuseTexture")) return made;
  const Value& texture = given.Get("diffuseTexture");
  made.texture = texture.Get("index").GetNumberAsInt();
  made.mapping = mapping_of(
      static_cast<int>(number_in(texture, "texCoord", 0)),
      texture.Has("extensions") ? texture.Get("extensions").Get<Value::Object>() : Value::Object());
  return made;
}

/// Share of light that a pane of glass transmits: its factor times the mean of the base colour.
/// A material that emits or transmits by a texture stays opaque, with a note.
double transmitted(const tinygltf::Material& source, const std::string& glass,
                   const ClpvMaterial& made, Notes& notes) {
  const auto found = source.extensions.find(kTransmission);
  if (found == source.extensions.end()) return 0;
  const bool textured = found->second.Has("transmissionTexture");
  const double factor = number_in(found->second, "transmissionFactor", 0);
  if (factor > 0 && (textured || emits(made))) {
    notes.add(fmt::format("{} transmits light: opaque here, since it {}", glass,
                          textured ? "has a transmissionTexture" : "emits"));
    return 0;
  }
  return factor * (made.base_colour[0] + made.base_colour[1] + made.base_colour[2]) / 3;
}

/// A material that stops half of light or more is opaque, a hole elsewhere: 1 - alpha (1 -
/// transmitted) passes.
void read_alpha(const tinygltf::Material& source, const std::string& place, ClpvMaterial& made,
                Notes& notes) {
  if (source.doubleSided) made.flags |= CLPV_MATERIAL_DOUBLE_SIDED;
  const std::string named = fmt::format("{} ('{}')", place, source.name);
  const double passes = transmitted(source, named, made, notes), cutoff = kStopped / (1 - passes);
  const bool blends = source.alphaMode == "BLEND", hole = passes > 1 - kStopped;
  if (source.alphaMode != "OPAQUE" || hole) made.flags |= CLPV_MATERIAL_MASKED;
  if (source.alphaMode == "MASK") made.alpha_cutoff = static_cast<float>(source.alphaCutoff);
  if (blends) made.alpha_cutoff = static_cast<float>(cutoff);
  if (hole) made.alpha_cutoff = kHoleCutoff;
  const std::string shown =
      hole     ? "a hole here, through which all light passes"
      : blends ? fmt::format("opaque where alpha reaches {:.2g}, a hole elsewhere", cutoff)
               : "opaque here";
  if (passes > 0) {
    notes.add(fmt::format("{} transmits {:.2g} of light: {}", named, passes, shown));
  } else if (blends) {
    notes.add(fmt::format("{} blends: {}", named, shown));
  }
}

void read_material(const GltfDocument& document, std::size_t index, MaterialSet& set,
                   Notes& notes) {
  const tinygltf::Material& source = document.model.materials[index];
  const std::string place = fmt::format("/materials/{}", index);
  ClpvMaterial made = blank_material();
  const BaseColour colour = base_colour_of(source);
  std::copy_n(colour.factor.begin(), 4, made.base_colour);
  double strength = 1;
  if (const auto found = source.extensions.find("KHR_materials_emissive_strength");
      found != source.extensions.end()) {
    strength = number_in(found->second, "emissiveStrength", 1);
  }
  for (std::size_t i = 0; i < 3; ++i)
    made.emissive[i] = static_cast<float>(source.emissiveFactor[i] * strength);
  read_alpha(source, place, made, notes);

  UvMapping mapping;
  if (colour.texture >= 0) made.texture = request(colour.texture, document, set, notes);
  if (made.texture != CLPV_NO_TEXTURE) mapping = colour.mapping;
  if (source.emissiveTexture.index >= 0 && emits(made)) {
    made.emissive_texture = request(source.emissiveTexture.index, document, set, notes);
    const UvMapping own =
        mapping_of(source.emissiveTexture.texCoord, source.emissiveTexture.extensions);
    if (made.texture == CLPV_NO_TEXTURE) {
      mapping = own;
    } else if (made.emissive_texture != CLPV_NO_TEXTURE && !(own == mapping)) {
      notes.add(
          place +
          "/emissiveTexture: uses the texture coordinates of baseColorTexture instead of its own");
    }
  }
  set.materials.push_back(made);
  set.mappings.push_back(mapping);
}

}  // namespace

MaterialSet read_materials(const GltfDocument& document, Notes& notes) {
  MaterialSet set;
  for (std::size_t i = 0; i < document.model.materials.size(); ++i)
    read_material(document, i, set, notes);
  set.materials.push_back(blank_material());
  set.mappings.emplace_back();
  return set;
}

}  // namespace clpv
