// SPDX-License-Identifier: MIT
#include "clpv/image.hpp"

#include "image/image_io.hpp"
#include "image/tone_map.hpp"
#include "support/error.hpp"

namespace clpv {

void save_image(const std::filesystem::path& path, const Image& image, float exposure) {
  const std::string extension = path.extension().string();
  if (extension == ".exr") return write_exr(path, image);
  if (extension == ".png") return write_png(path, display_image(image, exposure, ToneMap::aces));
  throw Error(ExitCode::usage, "{}: found extension '{}', allowed: .exr, .png", path.string(), extension);
}

}  // namespace clpv
