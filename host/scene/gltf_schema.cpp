// SPDX-License-Identifier: MIT
// Schema of glTF documents, as far as the loader and tinygltf read them.
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>
#include <numbers>

#include "scene/bounds.hpp"
#include "scene/gltf_document.hpp"
#include "scene/motion.hpp"
#include "scene/scene.hpp"
#include "support/error.hpp"
#include "support/json_schema.hpp"

namespace clpv {

using nlohmann::json;

namespace {

// Maximum of unbounded numbers; products with coordinates fit a double.
constexpr double kAny = 1e30;
constexpr double kMany = 4294967295;  // maximum of counts and offsets
constexpr double kInt = 2147483647;   // maximum of counts and offsets that tinygltf stores as int
// Maximum intensity and colour of a light: their product fits a float.
constexpr double kBrightest = 1e15;
constexpr std::size_t kTargets = 1024;    // maximum morph targets of a primitive
constexpr double kAboveZero = 1e-9;       // minimum of positive numbers
constexpr double kRightAngle = 1.570797;  // pi/2 as a float, or in seven digits, rounded up
const std::string kPunctual = "/extensions/KHR_lights_punctual";

/// Supported extensions. A file that requires others is rejected.
constexpr std::array kExtensions = {"KHR_lights_punctual",
                                    "KHR_texture_transform",
                                    "KHR_mesh_quantization",
                                    "KHR_materials_emissive_strength",
                                    "KHR_materials_pbrSpecularGlossiness",
                                    "KHR_materials_transmission",
                                    "EXT_texture_webp",
                                    "EXT_mesh_gpu_instancing"};

using Rules = std::vector<Rule>;

void append(Rules& rules, Rules more) {
  rules.insert(rules.end(), std::make_move_iterator(more.begin()),
               std::make_move_iterator(more.end()));
}

/// Rules of the top level. Rules of lists come first, as later rules check indices into them.
Rules document_rules() {
  using namespace rule;
  Rules rules = {object("").must(), object("/asset").must(), text("/asset/version").must(),
                 text("/asset/minVersion"), object("/extensions")};
  for (const char* name : {"scenes", "nodes", "meshes", "accessors", "bufferViews", "buffers",
                           "textures", "images", "samplers", "animations", "skins"}) {
    rules.push_back(list(std::string("/") + name, 0, bounds::kListEntries));
    rules.push_back(object(std::string("/") + name + "/*"));
  }
  append(rules, {list("/materials", 0, bounds::kMaterials), object("/materials/*"),
                 list("/cameras", 0, bounds::kCameras), object("/cameras/*"), object(kPunctual),
                 list(kPunctual + "/lights", 0, bounds::kLights), object(kPunctual + "/lights/*")});
  for (const char* name : {"extensionsUsed", "extensionsRequired"}) {
    rules.push_back(list(std::string("/") + name, 0, 1024));
    rules.push_back(text(std::string("/") + name + "/*"));
  }
  return rules;
}

Rules node_rules() {
  using namespace rule;
  const std::string light = "/nodes/*/extensions/KHR_lights_punctual",
                    instances = "/nodes/*/extensions/EXT_mesh_gpu_instancing";
  return {index("/scene", "/scenes"),
          list("/scenes/*/nodes", 0, bounds::kListEntries),
          index("/scenes/*/nodes/*", "/nodes"),
          list("/nodes/*/children", 0, bounds::kListEntries),
          index("/nodes/*/children/*", "/nodes"),
          index("/nodes/*/mesh", "/meshes"),
          index("/nodes/*/camera", "/cameras"),
          index("/nodes/*/skin", "/skins"),
          list("/nodes/*/weights", 0, kTargets),
          number("/nodes/*/weights/*", -kAny, kAny),
          list("/skins/*/joints", 1, bounds::kJoints).must(),
          index("/skins/*/joints/*", "/nodes"),
          index("/skins/*/inverseBindMatrices", "/accessors"),
          vector("/nodes/*/matrix", 16, -kAny, kAny),
          vector("/nodes/*/translation", 3, -kAny, kAny),
          vector("/nodes/*/rotation", 4, -1.001, 1.001),
          vector("/nodes/*/scale", 3, -kAny, kAny),
          object("/nodes/*/extensions"),
          object(light),
          index(light + "/light", kPunctual + "/lights").must(),
          object(instances),
          object(instances + "/attributes").must(),
          index(instances + "/attributes/*", "/accessors")};
}

Rules geometry_rules() {
  using namespace rule;
  const std::string primitive = "/meshes/*/primitives/*";
  return {
      list("/meshes/*/primitives", 1, bounds::kListEntries).must(),
      object(primitive),
      object(primitive + "/attributes").must(),
      index(primitive + "/attributes/*", "/accessors"),
      index(primitive + "/indices", "/accessors"),
      index(primitive + "/material", "/materials"),
      integer(primitive + "/mode", 0, 6),
      list("/meshes/*/weights", 0, kTargets),
      number("/meshes/*/weights/*", -kAny, kAny),
      list(primitive + "/targets", 0, kTargets),
      object(primitive + "/targets/*"),
      index(primitive + "/targets/*/*", "/accessors"),
      integer("/accessors/*/count", 1, kMany).must(),
      integer("/accessors/*/byteOffset", 0, kMany),
      index("/accessors/*/bufferView", "/bufferViews"),
      choice("/accessors/*/componentType", {5120, 5121, 5122, 5123, 5125, 5126}).must(),
      text("/accessors/*/type", {"SCALAR", "VEC2", "VEC3", "VEC4", "MAT2", "MAT3", "MAT4"}).must(),
      flag("/accessors/*/normalized"),
      object("/accessors/*/sparse"),
      integer("/accessors/*/sparse/count", 1, kInt).must(),
      object("/accessors/*/sparse/indices").must(),
      index("/accessors/*/sparse/indices/bufferView", "/bufferViews").must(),
      integer("/accessors/*/sparse/indices/byteOffset", 0, kInt),
      choice("/accessors/*/sparse/indices/componentType", {5121, 5123, 5125}).must(),
      object("/accessors/*/sparse/values").must(),
      index("/accessors/*/sparse/values/bufferView", "/bufferViews").must(),
      integer("/accessors/*/sparse/values/byteOffset", 0, kInt),
      index("/bufferViews/*/buffer", "/buffers").must(),
      integer("/bufferViews/*/byteOffset", 0, kMany),
      integer("/bufferViews/*/byteLength", 1, kMany).must(),
      integer("/bufferViews/*/byteStride", 4, 252),
      integer("/buffers/*/byteLength", 1, static_cast<double>(bounds::kBufferBytes)).must(),
      text("/buffers/*/uri")};
}

/// Rules of a material's reference to a texture.
Rules texture_info_rules(const std::string& place) {
  using namespace rule;
  const std::string transform = place + "/extensions/KHR_texture_transform";
  return {object(place),
          index(place + "/index", "/textures").must(),
          integer(place + "/texCoord", 0, 255),
          object(place + "/extensions"),
          object(transform),
          vector(transform + "/offset", 2, -kAny, kAny),
          number(transform + "/rotation", -kAny, kAny),
          vector(transform + "/scale", 2, -kAny, kAny),
          integer(transform + "/texCoord", 0, 255)};
}

Rules material_rules() {
  using namespace rule;
  const std::string strength = "/materials/*/extensions/KHR_materials_emissive_strength",
                    diffuse = "/materials/*/extensions/KHR_materials_pbrSpecularGlossiness",
                    transmission = "/materials/*/extensions/KHR_materials_transmission",
                    webp = "/textures/*/extensions/EXT_texture_webp";
  Rules rules = {object("/materials/*/pbrMetallicRoughness"),
                 vector("/materials/*/pbrMetallicRoughness/baseColorFactor", 4, 0, 1),
                 vector("/materials/*/emissiveFactor", 3, 0, 1),
                 text("/materials/*/alphaMode", {"OPAQUE", "MASK", "BLEND"}),
                 number("/materials/*/alphaCutoff", 0, kAny),
                 flag("/materials/*/doubleSided"),
                 object("/materials/*/extensions"),
                 object(strength),
                 number(strength + "/emissiveStrength", 0, bounds::kEmission),
                 object(diffuse),
                 vector(diffuse + "/diffuseFactor", 4, 0, 1),
                 object(transmission),
                 number(transmission + "/transmissionFactor", 0, 1),
                 index("/textures/*/source", "/images"),
                 object("/textures/*/extensions"),
                 object(webp),
                 index(webp + "/source", "/images"),
                 index("/textures/*/sampler", "/samplers"),
                 choice("/samplers/*/wrapS", {10497, 33071, 33648}),
                 choice("/samplers/*/wrapT", {10497, 33071, 33648}),
                 text("/images/*/uri"),
                 index("/images/*/bufferView", "/bufferViews")};
  append(rules, texture_info_rules("/materials/*/pbrMetallicRoughness/baseColorTexture"));
  append(rules, texture_info_rules("/materials/*/emissiveTexture"));
  append(rules, texture_info_rules(diffuse + "/diffuseTexture"));
  return rules;
}

Rules view_rules() {
  using namespace rule;
  const std::string light = kPunctual + "/lights/*";
  return {text("/cameras/*/type", {"perspective", "orthographic"}).must(),
          number("/cameras/*/perspective/yfov", kAboveZero, std::numbers::pi - kAboveZero).must(),
          number("/cameras/*/perspective/znear", kAboveZero, kAny).must(),
          text(light + "/type", names_of<LightKind>()).must(),
          vector(light + "/color", 3, 0, kBrightest),
          number(light + "/intensity", 0, kBrightest),
          number(light + "/range", kAboveZero, kAny),
          object(light + "/spot"),
          number(light + "/spot/innerConeAngle", 0, kRightAngle),
          number(light + "/spot/outerConeAngle", kAboveZero, kRightAngle)};
}

Rules animation_rules() {
  using namespace rule;
  const std::string samplers = "/animations/*/samplers", channels = "/animations/*/channels";
  return {
      list(samplers, 1, bounds::kListEntries).must(),
      object(samplers + "/*"),
      index(samplers + "/*/input", "/accessors").must(),
      index(samplers + "/*/output", "/accessors").must(),
      text(samplers + "/*/interpolation", names_of<Interpolation>()),
      list(channels, 1, bounds::kListEntries).must(),
      object(channels + "/*"),
      integer(channels + "/*/sampler", 0, kInt).must(),
      object(channels + "/*/target").must(),
      index(channels + "/*/target/node", "/nodes"),
      text(channels + "/*/target/path", {"translation", "rotation", "scale", "weights", "pointer"})
          .must(),
      object("/animations/*/extensions")};
}

void check_asset(const json& document, const std::string& file) {
  const std::string& version = document["asset"]["version"].get_ref<const std::string&>();
  if (!version.starts_with("2."))
    reject(file, "/asset/version", "'" + version.substr(0, 60) + "'", "2.x");
  // A model of version 2.x can be read by readers of 2.0, unless minVersion is higher.
  const std::string minimum = document["asset"].value("minVersion", "2.0");
  if (minimum != "2.0") reject(file, "/asset/minVersion", "'" + minimum.substr(0, 60) + "'", "2.0");
  if (!document.contains("extensionsRequired")) return;
  for (std::size_t i = 0; i < document["extensionsRequired"].size(); ++i) {
    const std::string& name = document["extensionsRequired"][i].get_ref<const std::string&>();
    if (!reads_extension(name)) {
      reject(file, fmt::format("/extensionsRequired/{}", i),
             "'" + name.substr(0, 80) + "', which is not supported",
             fmt::format("{}", fmt::join(kExtensions, ", ")));
    }
  }
}

/// Calls `check(entry, place)` for each entry of one of the document's lists.
template <typename Check>
void for_each_in(const json& document, const char* list, const Check& check) {
  if (!document.contains(list)) return;
  for (std::size_t i = 0; i < document[list].size(); ++i)
    check(document[list][i], fmt::format("/{}/{}", list, i));
}

/// Checks the size of all buffers together. tinygltf uses the binary chunk for every buffer without
/// a uri, while glTF allows that for the first only.
void check_buffers(const json& document, const std::string& file) {
  std::uint64_t total = 0;
  for_each_in(document, "buffers", [&](const json& buffer, const std::string& place) {
    if (!buffer.contains("uri") && total > 0)
      reject(file, place, "no uri", "a uri, but for the first buffer of a .glb");
    total += buffer["byteLength"].get<std::uint64_t>();
    if (total > bounds::kBufferBytes) {
      reject(file, place + "/byteLength", fmt::format("{} bytes of buffers so far", total),
             fmt::format("at most {} in all", bounds::kBufferBytes));
    }
  });
}

void check_views(const json& document, const std::string& file) {
  for_each_in(document, "bufferViews", [&](const json& view, const std::string& place) {
    const std::uint64_t end =
        view.value("byteOffset", std::uint64_t{0}) + view["byteLength"].get<std::uint64_t>();
    const std::size_t buffer = view["buffer"];
    const std::uint64_t size = document["buffers"][buffer]["byteLength"];
    if (end > size) {
      reject(file, place, fmt::format("bytes up to {}", end),
             fmt::format("at most the {} of /buffers/{}", size, buffer));
    }
  });
}

/// Rejects indices without a view by place, as tinygltf's message has no place.
void check_indices(const json& document, const std::string& file) {
  for_each_in(document, "meshes", [&](const json& mesh, const std::string& place) {
    for (const json& primitive : mesh["primitives"]) {
      if (!primitive.contains("indices")) continue;
      const std::size_t accessor = primitive["indices"];
      if (document["accessors"][accessor].contains("bufferView")) continue;
      reject(file, place + "/primitives",
             fmt::format("indices of /accessors/{}, which has no bufferView", accessor),
             "an accessor with a bufferView");
    }
  });
}

/// Bounds the extensions of animations, as tinygltf 2.7 copies them into each sampler.
void check_animations(const json& document, const std::string& file) {
  for_each_in(document, "animations", [&](const json& animation, const std::string& place) {
    if (!animation.contains("extensions")) return;
    const std::size_t copied = animation["samplers"].size() * animation["extensions"].dump().size();
    if (copied > bounds::kJsonValues) {
      reject(file, place + "/extensions", fmt::format("{} bytes, for all samplers", copied),
             fmt::format("at most {}", bounds::kJsonValues));
    }
  });
}

}  // namespace

bool reads_extension(const std::string& name) {
  return std::find(kExtensions.begin(), kExtensions.end(), name) != kExtensions.end();
}

void check_gltf(const json& document, const std::string& file) {
  static const Rules rules = [] {
    Rules all = document_rules();
    append(all, node_rules());
    append(all, geometry_rules());
    append(all, material_rules());
    append(all, view_rules());
    append(all, animation_rules());
    return all;
  }();
  check_rules(document, rules, file);
  check_asset(document, file);
  check_buffers(document, file);
  check_views(document, file);
  check_indices(document, file);
  check_animations(document, file);
}

}  // namespace clpv
