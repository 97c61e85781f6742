// SPDX-License-Identifier: MIT
#include "cli/image_layer.hpp"

#include "image/image_io.hpp"
#include "support/log.hpp"

namespace clpv {

Image read_image_layer(const std::filesystem::path& file, const std::string& layer) {
  Image image = extract_layer(read_image(file), layer, file.string());
  for (const std::string& note : image.notes) log_warning("{}: {}", file.string(), note);
  return image;
}

}  // namespace clpv
