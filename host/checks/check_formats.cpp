// SPDX-License-Identifier: MIT
// What the checks of all stages that reach volumes have in common: formats, and their tolerances.
#include "checks/check.hpp"
#include "checks/tolerances.hpp"
#include "support/log.hpp"

namespace clpv::reference {

std::vector<VolumeFormat> other_formats(const Device& device, const VolumeShape& shape) {
  std::vector<VolumeFormat> formats;
  for (const VolumeFormat& format : all_formats()) {
    if (format == VolumeFormat{}) continue;
    if (const auto reason = unsupported(device, format, shape)) {
      spdlog::info("{} on {} is unsupported: {}", format_name(format), device.name, *reason);
    } else {
      formats.push_back(format);
    }
  }
  return formats;
}

double tolerance_in(std::string_view stage, const VolumeFormat& format) {
  return format.storage == Storage::float16 ? half_tolerance(stage) : tolerance(stage);
}

}  // namespace clpv::reference
