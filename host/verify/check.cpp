// SPDX-License-Identifier: MIT
#include "verify/check.hpp"

#include "support/log.hpp"

namespace clpv::reference {
namespace {

constexpr StageCheck* kChecks[] = {check_sizes,    check_rasterize,  check_emit,      check_inject,
                                   check_blockers, check_reflectors, check_propagate, check_sweep,
                                   check_bounce,   check_visibility, check_gather,    check_near,
                                   check_medium,   check_shade};
static_assert(std::size(kChecks) == kNames<Stage>.size());

}  // namespace

CheckResults check(Stage stage, Session& session, const CheckScope& scope) {
  return kChecks[static_cast<std::size_t>(stage)](session, scope);
}

CheckScope thorough_scope() {
  return {.thorough = true, .bases = basis_names(), .formats = all_formats()};
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

}  // namespace clpv::reference
