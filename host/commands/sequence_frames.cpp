// SPDX-License-Identifier: MIT
#include "commands/sequence_frames.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "evaluate/cached_reference.hpp"
#include "image/image_io.hpp"
#include "pipeline/view.hpp"
#include "support/error.hpp"
#include "support/fingerprint.hpp"
#include "support/log.hpp"
#include "support/named_enum.hpp"

namespace clpv {
namespace {

namespace fs = std::filesystem;

constexpr const char* kMadeOf = "made_of";  // metadata: a FrameIdentity's name

}  // namespace

fs::path frame_file(const fs::path& folder, int frame, FrameFormat format) {
  return folder / fmt::format("frame-{:04}.{}", frame, name_of(format));
}

FrameIdentity::FrameIdentity(const Scene& scene, const Device& device, const RenderOptions& options)
    : width_(options.width), height_(options.height) {
  Fingerprint print;
  print.add(program_fingerprint()).add(device.platform).add(device.name).add(device.driver);
  still_ = print.add(reference::scene_fingerprint(scene)).hex();
}

std::string FrameIdentity::of(const Scene& posed, const Camera& camera,
                              const nlohmann::json& described) const {
  Fingerprint print;
  print.add(still_).add(described.dump()).add(std::vector{camera_view(camera, width_, height_)});
  add_moving(print, posed);
  for (const Light& light : posed.lights_for(camera)) print.add(std::vector{light.data});
  return print.hex();
}

bool holds_frame(const fs::path& file, const std::string& identity) {
  std::error_code unknown;
  if (!fs::exists(file, unknown)) return false;
  try {
    const std::map<std::string, std::string> metadata = read_metadata(file);
    const auto found = metadata.find(kMadeOf);
    return found != metadata.end() && found->second == identity;
  } catch (const Error& error) {
    spdlog::warn("{}; it is rendered again", error.what());
    return false;
  }
}

void write_frame(const fs::path& file, FrameFormat format, Image image, const nlohmann::json& described,
                 const std::string& identity) {
  image.metadata = metadata_of(described);
  image.metadata[kMadeOf] = identity;
  switch (format) {
    case FrameFormat::exr:
      return write_exr(file, image);
    case FrameFormat::png: {
      const auto curve = named<ToneMap>("tonemap", described["tonemap"].get_ref<const std::string&>());
      return write_png(file, display_image(image, described["exposure"].get<float>(), curve));
    }
  }
}

}  // namespace clpv
