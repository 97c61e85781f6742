// SPDX-License-Identifier: MIT
// Implements devices, images and options of the public interface.
#include "clpv/device.hpp"
#include "clpv/image.hpp"
#include "clpv/options.hpp"
#include "device/device.hpp"
#include "image/compare.hpp"
#include "image/image_io.hpp"
#include "image/tone_map.hpp"
#include "options/render_options.hpp"
#include "support/error.hpp"
#include "support/text.hpp"

namespace clpv {

std::vector<DeviceDescription> all_devices() {
  std::vector<DeviceDescription> all;
  for (const Device& device : list_devices().devices)
    all.push_back(
        {device.index, device.name, device.platform, device.driver, device.type, device.missing});
  return all;
}

void save_image(const std::filesystem::path& path, const Image& image, std::optional<float> given) {
  check_image("image", image);
  const float exposure = given ? *given : automatic_exposure(image);
  check_exposure(exposure);
  const std::string extension = lower_extension(path);
  if (extension == ".exr") {
    require_linear("image", image);
    return write_exr(path, image);
  }
  if (extension == ".png") return write_png(path, display_image(image, exposure, kDisplayCurve));
  throw Error(ExitCode::usage, "{}: found extension '{}', allowed: .exr, .png", path.string(),
              path.extension().string());
}

Options& Options::set(std::string_view name, std::string_view value) {
  RenderOptions probe;
  set_option(probe, name, value);
  given_[std::string(name)] = value;
  return *this;
}

std::vector<OptionDescription> Options::all() {
  return list_options(RenderOptions{});
}

Comparison compare(const Image& a, const Image& b, float exposure) {
  check_image("the image", a);
  check_image("its reference", b);
  check_exposure(exposure);
  return compare(a, "the image", b, "its reference", exposure);
}

}  // namespace clpv
