// SPDX-License-Identifier: MIT
// Scenes out of bytes, for the targets of models and scene files.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

#include "scene/load.hpp"
#include "tests/fuzz/fuzz.hpp"
#include "tests/support/tiny_images.hpp"

namespace clpv::fuzz {

inline constexpr double kInstants[] = {-1, 0, 0.25, 1, 1e6};  // [s]; before, at and after keys

/// A triangle from 36 bytes of model.bin, which are zeros but for its corners.
inline constexpr std::string_view kSound =
    R"({"asset": {"version": "2.0"}, "buffers": [{"byteLength": 36, "uri":
"model.bin"}], "bufferViews": [{"buffer": 0, "byteLength": 36}], "accessors": [{"bufferView": 0, "componentType": 5126,
"count": 3, "type": "VEC3"}], "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}], "nodes": [{"mesh": 0}]})";

/// The same with image.png on it, and a scene of that under sky.hdr.
inline std::string textured() {
  nlohmann::json model = nlohmann::json::parse(kSound);
  model["images"][0]["uri"] = "image.png";
  model["textures"][0]["source"] = 0;
  model["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"]["index"] = 0;
  model["meshes"][0]["primitives"][0]["material"] = 0;
  return model.dump();
}

inline constexpr std::string_view kUnderSky =
    R"({"model": "textured.gltf", "sky": {"map": "sky.hdr"}})";

/// The files that URIs may name. An input that names one must not end there: they are read here,
/// and must not be rejected.
inline void write_neighbours() {
  const float corners[9] = {0, 0, 0, 1, 0, 0, 0, 1, 0};
  std::string bytes(reinterpret_cast<const char*>(corners), sizeof corners);
  bytes.resize(1024, '\0');
  folder().write("model.bin", bytes);
  folder().write("sound.gltf", kSound);
  folder().write("image.png", test::decode_base64(test::kPngGrey));
  folder().write("sky.hdr", std::string_view("#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 2\n"
                                             "\x40\x80\x20\x80\x80\x40\x20\x81"));  // two texels
  folder().write("textured.gltf", textured());
  MovingScene(folder().write("under_sky.json", kUnderSky));
}

/// Reads the scene under that name, and shows it at several instants.
inline void load_model(const std::string& name, std::string_view bytes) {
  static const bool written = (write_neighbours(), true);
  static_cast<void>(written);
  const std::filesystem::path path = folder().write(name, bytes);
  read_or_reject({ExitCode::bad_input}, [&] {
    MovingScene moving(path);
    for (const double instant : kInstants) {
      if (moving.moves()) read_or_reject({ExitCode::bad_input}, [&] { moving.pose(instant); });
    }
  });
}

}  // namespace clpv::fuzz
