// SPDX-License-Identifier: MIT
// Keys of results that outlive a process: an input missing from them is a bug.
#pragma once

#include <string>

#include "device/device.hpp"
#include "options/render_options.hpp"

namespace clpv {

/// Key of pixels, apart from scene and camera: program, text of all kernels, device, driver and its
/// settings, lanes, and options with the content of the file of `centres`. Sub-devices and numbers
/// of threads do not change pixels.
std::string pixels_key(const Device& device, const RenderOptions& options);

/// Key of times of such frames: also compute units, all settings of the driver, and the number of
/// `processors` that this process may use (Ranks::processors).
std::string times_key(const Device& device, const RenderOptions& options, int processors);

}  // namespace clpv
