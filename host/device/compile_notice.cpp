// SPDX-License-Identifier: MIT
#include "device/compile_notice.hpp"

#include "support/log.hpp"

namespace clpv {
namespace {

constexpr double kPatienceMs = 1000;  // who waits longer asks what for

}  // namespace

void tell_of_compiling(const std::string& device, double before_ms, double ms) {
  if (before_ms <= kPatienceMs && ms > kPatienceMs)
    spdlog::info("compiling kernels for {}, which takes a while the first time", device);
}

void tell_of_keeping(double ms) {
  if (ms > kPatienceMs) spdlog::info("keeping the compiled kernels for later starts");
}

}  // namespace clpv
