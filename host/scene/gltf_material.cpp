// SPDX-License-Identifier: MIT
// Reads materials. Metals reflect their base colour diffusely, unlike in glTF, as light propagation
// volumes carry diffuse light only. Metalness, roughness, specular and normal maps are not read.
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <optional>

#include "scene/bounds.hpp"
#include "scene/gltf_parts.hpp"
#include "support/error.hpp"

namespace clpv {
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

bool emits(const ClpvMaterial& material) {
  return material.emissive[0] + material.emissive[1] + material.emissive[2] > 0;
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
