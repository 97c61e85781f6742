// SPDX-License-Identifier: MIT
// Files of scenes, and options of small frames.
#pragma once

#include <cstdlib>
#include <filesystem>
#include <string>

#include "clpv/options.hpp"

namespace clpv::test {

inline const std::string kCornell = CLPV_SOURCE_DIR "/scenes/cornell.json",
                         kTiny = CLPV_SOURCE_DIR "/tests/support/tiny.gltf",
                         kTinyRoom = CLPV_SOURCE_DIR "/tests/support/tiny.json";  // one cascade

/// Options of a small frame by few steps, for starts of the program that need any frame.
inline const std::string kSmallSteps =
    " --width 12 --height 9 --grid 5 --cascades 1 --cascade-size 5 --rsm-size 8 --shadow-size 8 "
    "--basis sh2 --transport sampled --gather all --blockers seen ";

inline std::filesystem::path scene_file(const std::string& name) {
  return std::filesystem::path(CLPV_SOURCE_DIR) / "scenes" / name;
}

/// Model of Crytek Sponza (a file or folder that CLPV_SPONZA names); empty if it is absent.
inline std::filesystem::path sponza() {
  const char* given = std::getenv("CLPV_SPONZA");
  std::filesystem::path path =
      given != nullptr && *given != '\0'
          ? std::filesystem::path(given)
          : std::filesystem::path(CLPV_SOURCE_DIR) / "../shared/scenes/sponza";
  if (std::filesystem::is_directory(path)) path /= "Sponza.gltf";
  return std::filesystem::exists(path) ? path : std::filesystem::path();
}

/// A small frame's sweep. All tests share its programs: other numbers need programs of their own.
inline const std::string kSmallSweep = " --grid 16 --directions 24 --coarser-directions 24 ",
                         kSweepOfOne = " --grid 16 --directions 24 --cascades 1 ";

inline Options small_images() {
  return Options().set("basis", "sh2").set("width", "48").set("height", "27").set("rsm-size", "64");
}

/// 48x27 pixels, sh2, kSmallSweep, RSMs of 64^2 texels.
inline Options small_options() {
  return small_images().set("grid", "16").set("directions", "24").set("coarser-directions", "24");
}

/// The same frame by the programs of kSmallSteps, for tests that need any frame.
inline Options few_steps() {
  return small_images()
      .set("grid", "5")
      .set("cascades", "1")
      .set("transport", "sampled")
      .set("gather", "all")
      .set("blockers", "seen");
}

}  // namespace clpv::test
