// SPDX-License-Identifier: MIT
// The frames of a sequence as files: what they are called, and whether one that is there is the one that is wanted.
#pragma once

#include <filesystem>
#include <string>

#include "commands/render_request.hpp"
#include "device/device.hpp"
#include "image/tone_map.hpp"
#include "support/named_enum.hpp"

namespace clpv {

enum class FrameFormat : unsigned { exr, png };

template <>
inline constexpr auto kNames<FrameFormat> = name_list("exr", "png");

/// DIR/frame-0000.exr and so on.
std::filesystem::path frame_file(const std::filesystem::path& folder, int frame, FrameFormat format);

/// Names what a frame is made of: program, device, options, the scene's contents and what of it is where at that instant.
/// Two frames of one name have the same pixels.
class FrameIdentity {
 public:
  /// Of frames of `scene`, which shows 0 s.
  FrameIdentity(const Scene& scene, const Device& device, const RenderOptions& options);

  /// `described`: by describe(), with the instant.
  std::string of(const Scene& posed, const Camera& camera, const nlohmann::json& described) const;

 private:
  std::string still_;
  int width_, height_;
};

/// Whether that file holds a frame of that identity. What cannot be read does not, with a warning.
bool holds_frame(const std::filesystem::path& file, const std::string& identity);

/// Writes a linear image, tone-mapped for a PNG, with the identity in its metadata beside the description.
void write_frame(const std::filesystem::path& file, FrameFormat format, Image image,
                 const nlohmann::json& described, const std::string& identity);

}  // namespace clpv
