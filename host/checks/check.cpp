// SPDX-License-Identifier: MIT
#include "checks/check.hpp"

#include "checks/tolerances.hpp"
#include "support/log.hpp"

namespace clpv::reference {

CheckResults check(Stage stage, Session& session, const CheckScope& scope) {
  switch (stage) {
    case Stage::sizes:
      return check_sizes(session);
    case Stage::rasterize:
      return check_rasterize(session);
    case Stage::emit:
      return check_emit(session);
    case Stage::inject:
      return check_inject(session, scope);
    case Stage::block:
      return check_block(session);
    case Stage::reflect:
      return check_reflect(session);
    case Stage::propagate:
      return check_propagate(session, scope);
    case Stage::sweep:
      return check_sweep(session, scope);
    case Stage::bounce:
      return check_bounce(session, scope);
    case Stage::see:
      return check_see(session);
    case Stage::gather:
      return check_gather(session, scope);
    case Stage::shade:
      return check_shade(session);
  }
  return {};
}

std::vector<VolumeFormat> other_formats(const Device& device, const VolumeShape& shape,
                                        const std::vector<VolumeFormat>& formats) {
  std::vector<VolumeFormat> supported;
  for (const VolumeFormat& format : formats) {
    if (format == VolumeFormat{}) continue;
    if (const auto reason = unsupported(device, format, shape)) {
      spdlog::info("{} on {} is unsupported: {}", format_name(format), device.name, *reason);
    } else {
      supported.push_back(format);
    }
  }
  return supported;
}

double tolerance_in(std::string_view stage, const VolumeFormat& format) {
  return format.storage == Storage::float16 ? half_tolerance(stage) : tolerance(stage);
}

}  // namespace clpv::reference
