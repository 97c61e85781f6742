// SPDX-License-Identifier: MIT
// Scenes out of bytes, for the targets of models and scene files.
#pragma once

#include <string>

#include "scene/load.hpp"
#include "tests/fuzz/fuzz.hpp"

namespace clpv::fuzz {

inline constexpr double kInstants[] = {-1, 0, 0.25, 1, 1e6};  // [s]; before, at and after keys

/// A triangle from 36 bytes of model.bin, which are zeros but for its corners.
inline constexpr std::string_view kSound =
    R"({"asset": {"version": "2.0"}, "buffers": [{"byteLength": 36, "uri":
"model.bin"}], "bufferViews": [{"buffer": 0, "byteLength": 36}], "accessors": [{"bufferView": 0, "componentType": 5126,
"count": 3, "type": "VEC3"}], "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}], "nodes": [{"mesh": 0}]})";

/// As much, and image.png on it, with a scene of it under sky.hdr.
inline constexpr std::string_view kTextured =
    R"({"asset": {"version": "2.0"}, "buffers": [{"byteLength": 36, "uri":
"model.bin"}], "bufferViews": [{"buffer": 0, "byteLength": 36}], "accessors": [{"bufferView": 0, "componentType": 5126,
"count": 3, "type": "VEC3"}], "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "material": 0}]}], "nodes":
[{"mesh": 0}], "images": [{"uri": "image.png"}], "textures": [{"source": 0}], "materials": [{"pbrMetallicRoughness":
{"baseColorTexture": {"index": 0}}}]})";
inline constexpr std::string_view kUnderSky = R"({"model": "textured.gltf", "sky": {"map": "sky.hdr"}})";

/// The files that URIs may name. An input that names one must not end there: they are read here, and must not be refused.
inline void write_neighbours() {
  const float corners[9] = {0, 0, 0, 1, 0, 0, 0, 1, 0};
  std::string bytes(reinterpret_cast<const char*>(corners), sizeof corners);
  bytes.resize(1024, '\0');
  folder().write("model.bin", bytes);
  folder().write("sound.gltf", kSound);
  const unsigned char grey[] = {0x89, 0x50, 0x4e, 0x47, 0x0d, 0x0a, 0x1a, 0x0a, 0,    0,    0, 0x0d,
                                0x49, 0x48, 0x44, 0x52, 0,    0,    0,    1,    0,    0,    0, 1,
                                8,    0,    0,    0,    0,    0x3a, 0x7e, 0x9b, 0x55, 0,    0, 0,
                                0x0a, 0x49, 0x44, 0x41, 0x54, 0x78, 0x9c, 0x63, 0xf0, 0x05, 0, 0,
                                0x4f, 0,    0x4e, 0x69, 0x8b, 0x01, 0x6c, 0,    0,    0,    0, 0x49,
                                0x45, 0x4e, 0x44, 0xae, 0x42, 0x60, 0x82};  // one pixel of 77
  folder().write("image.png", {reinterpret_cast<const char*>(grey), sizeof grey});
  folder().write("sky.hdr", std::string_view("#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 2\n"
                                             "\x40\x80\x20\x80\x80\x40\x20\x81"));  // two texels
  folder().write("textured.gltf", kTextured);
  MovingScene(folder().write("under_sky.json", kUnderSky));
}

/// Reads the scene under that name, and shows it at several instants.
inline void load_model(const std::string& name, std::string_view bytes) {
  static const bool written = (write_neighbours(), true);
  static_cast<void>(written);
  const std::filesystem::path path = folder().write(name, bytes);
  read_or_refuse({ExitCode::bad_input}, [&] {
    MovingScene moving(path);
    for (const double instant : kInstants) {
      if (moving.moves()) read_or_refuse({ExitCode::bad_input}, [&] { moving.pose(instant); });
    }
  });
}

}  // namespace clpv::fuzz
