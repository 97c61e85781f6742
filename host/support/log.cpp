// SPDX-License-Identifier: MIT
#include "support/log.hpp"

#include <spdlog/sinks/stdout_sinks.h>

namespace clpv {

void set_log_level(bool quiet, int verbosity) {
  static const auto logger = [] {
    auto made = std::make_shared<spdlog::logger>("clpv", std::make_shared<spdlog::sinks::stderr_sink_mt>());
    made->set_pattern("clpv: %v");
    spdlog::set_default_logger(made);
    return made;
  }();
  logger->set_level(quiet            ? spdlog::level::err
                    : verbosity >= 2 ? spdlog::level::trace
                    : verbosity == 1 ? spdlog::level::debug
                                     : spdlog::level::info);
}

}  // namespace clpv
