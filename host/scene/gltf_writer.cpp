// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>
#include <numbers>
#include <span>

#include "clpv/version.hpp"
#include "image/image_io.hpp"
#include "scene/load.hpp"
#include "scene/scene.hpp"
#include "scene/view_values.hpp"
#include "support/array_files.hpp"
#include "support/error.hpp"
#include "support/log.hpp"
#include "support/output_file.hpp"
#include "support/text.hpp"

namespace clpv {
namespace {

using Json = nlohmann::json;

constexpr const char* kLightsExtension = "KHR_lights_punctual";
constexpr const char* kStrengthExtension = "KHR_materials_emissive_strength";

/// Column-major matrix of a node whose -z is `forward`.
Json matrix(const glm::dvec3& forward, const glm::dvec3& up, const glm::dvec3& at) {
  const glm::dvec3 right = glm::normalize(glm::cross(forward, up)),
                   above = glm::cross(right, forward);
  return {right.x,    right.y,    right.z,    0, above.x, above.y, above.z, 0,
          -forward.x, -forward.y, -forward.z, 0, at.x,    at.y,    at.z,    1};
}

/// The document and its binary part.
class GlbWriter {
 public:
  explicit GlbWriter(const SceneData& scene) : scene_(scene) {
    document_ = {{"asset", {{"version", "2.0"}, {"generator", "clpv " + version()}}}, {"scene", 0}};
  }

  std::string file() {
    for (const Texture& texture : scene_.textures) add(texture);
    for (const ClpvMaterial& material : scene_.materials) add(material);
    add_triangles();
    for (const SceneCamera& camera : scene_.cameras) add(camera);
    for (const SceneLight& light : scene_.lights) add(light);
    Json nodes = Json::array();
    for (std::size_t i = 0; i < document_["nodes"].size(); ++i) nodes.push_back(i);
    document_["scenes"].push_back({{"nodes", nodes}});
    if (!binary_.empty()) document_["buffers"].push_back({{"byteLength", binary_.size()}});
    if (!extensions_.empty()) document_["extensionsUsed"] = extensions_;
    std::string text = document_.dump();
    text.resize((text.size() + 3) / 4 * 4, ' ');
    const std::size_t bytes = 12 + 8 + text.size() + (binary_.empty() ? 0 : 8 + binary_.size());
    if (bytes > std::numeric_limits<std::uint32_t>::max())
      throw Error(ExitCode::run_time, "save: found {} bytes, allowed in a .glb: below 4 GiB",
                  bytes);
    std::string file = "glTF";
    const auto word = [](std::size_t value) { return static_cast<std::uint32_t>(value); };
    append_little(file, word(2), word(bytes), word(text.size()));
    file += "JSON" + text;
    if (binary_.empty()) return file;
    append_little(file, word(binary_.size()));
    return file + std::string("BIN\0", 4) + binary_;
  }

 private:
  /// Adds bytes to the binary part; returns the index of their view.
  std::size_t view(std::span<const std::byte> bytes) {
    document_["bufferViews"].push_back(
        {{"buffer", 0}, {"byteOffset", binary_.size()}, {"byteLength", bytes.size()}});
    binary_.append(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    binary_.resize((binary_.size() + 3) / 4 * 4);
    return document_["bufferViews"].size() - 1;
  }

  template <typename T>
  std::size_t accessor(const std::vector<T>& values, int components, const char* type) {
    document_["accessors"].push_back({{"bufferView", view(std::as_bytes(std::span(values)))},
                                      {"componentType", std::is_same_v<T, float> ? 5126 : 5125},
                                      {"count", values.size() / components},
                                      {"type", type}});
    return document_["accessors"].size() - 1;
  }

  void uses(const char* extension) {
    if (std::ranges::count(extensions_, extension) == 0) extensions_.emplace_back(extension);
  }

  void add(const Texture& texture) {
    Image image;
    image.width = static_cast<int>(texture.width), image.height = static_cast<int>(texture.height);
    image.channels = {"R", "G", "B", "A"}, image.encoding = Encoding::srgb;
    for (const std::uint8_t value : texture.rgba)
      image.pixels.push_back(static_cast<float>(value) / 255.0f);
    const std::vector<unsigned char> png = png_bytes(image);
    const std::size_t index = document_["textures"].size();
    document_["images"].push_back(
        {{"bufferView", view(std::as_bytes(std::span(png)))}, {"mimeType", "image/png"}});
    const auto wrap = [](std::uint32_t given) {
      return given == CLPV_WRAP_CLAMP ? 33071 : given == CLPV_WRAP_MIRROR ? 33648 : 10497;
    };
    document_["samplers"].push_back(
        {{"wrapS", wrap(texture.wrap_u)}, {"wrapT", wrap(texture.wrap_v)}});
    document_["textures"].push_back({{"source", index}, {"sampler", index}});
  }

  void add(const ClpvMaterial& material) {
    Json pbr = {{"baseColorFactor", material.base_colour}, {"metallicFactor", 0}};
    if (material.texture != CLPV_NO_TEXTURE)
      pbr["baseColorTexture"] = {{"index", material.texture}};
    Json made = {{"pbrMetallicRoughness", pbr},
                 {"doubleSided", (material.flags & CLPV_MATERIAL_DOUBLE_SIDED) != 0}};
    const double most =
        std::max({material.emissive[0], material.emissive[1], material.emissive[2]});
    const double strength = std::max(most, 1.0);  // a factor is at most 1
    for (const float emissive : material.emissive)
      made["emissiveFactor"].push_back(emissive / strength);
    if (strength > 1) {
      uses(kStrengthExtension);
      made["extensions"][kStrengthExtension] = {{"emissiveStrength", strength}};
    }
    if (material.emissive_texture != CLPV_NO_TEXTURE)
      made["emissiveTexture"] = {{"index", material.emissive_texture}};
    if ((material.flags & CLPV_MATERIAL_MASKED) != 0)
      made.update({{"alphaMode", "MASK"}, {"alphaCutoff", material.alpha_cutoff}});
    document_["materials"].push_back(made);
  }

  /// One mesh, with a primitive for each material, which has its vertices.
  void add_triangles() {
    std::map<std::uint32_t, std::vector<std::uint32_t>> corners;
    for (const Triangle& triangle : scene_.triangles)
      for (const std::uint32_t vertex : triangle.vertex)
        corners[triangle.material].push_back(vertex);
    if (corners.empty()) return;
    Json primitives;
    for (auto& [material, indices] : corners) {
      std::vector<float> positions, normals, uvs, colours;
      std::map<std::uint32_t, std::uint32_t> places;
      for (std::uint32_t& index : indices) {
        const auto [place, added] =
            places.try_emplace(index, static_cast<std::uint32_t>(places.size()));
        const Vertex& vertex = scene_.vertices[index];
        index = place->second;
        if (!added) continue;
        positions.insert(positions.end(), std::begin(vertex.position), std::end(vertex.position));
        normals.insert(normals.end(), std::begin(vertex.normal), std::end(vertex.normal));
        uvs.insert(uvs.end(), std::begin(vertex.uv), std::end(vertex.uv));
        colours.insert(colours.end(), std::begin(vertex.colour), std::end(vertex.colour));
      }
      const Json attributes = {{"POSITION", bounded(accessor(positions, 3, "VEC3"), positions)},
                               {"NORMAL", accessor(normals, 3, "VEC3")},
                               {"TEXCOORD_0", accessor(uvs, 2, "VEC2")},
                               {"COLOR_0", accessor(colours, 4, "VEC4")}};
      primitives.push_back({{"attributes", attributes},
                            {"indices", accessor(indices, 1, "SCALAR")},
                            {"material", material}});
    }
    document_["meshes"].push_back({{"primitives", primitives}});
    document_["nodes"].push_back({{"mesh", 0}});
  }

  /// Adds the bounds that glTF requires of positions.
  std::size_t bounded(std::size_t index, const std::vector<float>& positions) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      float lower = positions[axis], upper = lower;
      for (std::size_t i = axis; i < positions.size(); i += 3)
        lower = std::min(lower, positions[i]), upper = std::max(upper, positions[i]);
      document_["accessors"][index]["min"].push_back(lower);
      document_["accessors"][index]["max"].push_back(upper);
    }
    return index;
  }

  void add(const SceneCamera& camera) {
    document_["nodes"].push_back(
        {{"name", printable(camera.name)},
         {"camera", document_["cameras"].size()},
         {"matrix",
          matrix(glm::dvec3(camera.forward), glm::dvec3(camera.up), glm::dvec3(camera.eye))}});
    document_["cameras"].push_back(
        {{"type", "perspective"},
         {"perspective", {{"yfov", camera.vertical_fov}, {"znear", camera.near_depth}}}});
  }

  void add(const SceneLight& light) {
    const Light given = light_of(light);
    const double most = *std::ranges::max_element(given.intensity);
    Json made = {{"name", printable(light.name)},
                 {"type", name_of(given.kind)},
                 {"intensity", most * scene_.light_scale}};
    for (const double channel : given.intensity)
      made["color"].push_back(most > 0 ? channel / most : 1);
    if (given.range > 0 && given.kind != LightKind::directional) made["range"] = given.range;
    constexpr double kRadian = std::numbers::pi / 180;
    if (given.kind == LightKind::spot)
      made["spot"] = {{"innerConeAngle", given.inner_cone_degrees * kRadian},
                      {"outerConeAngle", given.outer_cone_degrees * kRadian}};
    const glm::dvec3 along = given.kind == LightKind::point
                                 ? glm::dvec3(0, 0, -1)
                                 : glm::normalize(vector(light.data.direction));
    const glm::dvec3 up = std::abs(along.y) < 0.9 ? glm::dvec3(0, 1, 0) : glm::dvec3(1, 0, 0);
    Json& all = document_["extensions"][kLightsExtension]["lights"];
    document_["nodes"].push_back({{"extensions", {{kLightsExtension, {{"light", all.size()}}}}},
                                  {"matrix", matrix(along, up, vector(light.data.position))}});
    all.push_back(made);
    uses(kLightsExtension);
  }

  const SceneData& scene_;
  Json document_;
  std::string binary_;
  std::vector<std::string> extensions_;
};

}  // namespace

void write_glb(const std::filesystem::path& path, const SceneData& scene) {
  if (lower_extension(path) != ".glb")
    throw Error(ExitCode::usage, "{}: found extension '{}', allowed: .glb", path.string(),
                path.extension().string());
  const auto lost = [&](bool found, const char* what) {
    if (found) log_warning("{}: {}: not written, since glTF has none", path.string(), what);
  };
  lost(scene.sky != nullptr, "the sky");
  lost(scene.medium.has_value(), "the medium");
  lost(std::ranges::any_of(scene.cameras, [](const auto& c) { return !c.light.empty(); }),
       "the only light of a camera");
  lost(scene.cascades || scene.cascade_size, "number and size of the cascades");
  lost(scene.exposure.has_value(), "the exposure");
  if (scene.lights.empty() && !scene.sky)
    log_warning("{}: no lights: clpv adds a sun where it reads a model without lights",
                path.string());
  write_file(path, GlbWriter(scene).file());
}

}  // namespace clpv
