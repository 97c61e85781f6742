// SPDX-License-Identifier: MIT
#include "support/log.hpp"

#include <spdlog/pattern_formatter.h>
#include <spdlog/sinks/stdout_sinks.h>

#include "support/text.hpp"

namespace clpv {
namespace {

/// The message without control characters, since it may quote names of untrusted scenes.
struct PrintableText : spdlog::custom_flag_formatter {
  void format(const spdlog::details::log_msg& message, const std::tm&,
              spdlog::memory_buf_t& line) override {
    const std::string text = printable({message.payload.data(), message.payload.size()});
    line.append(text.data(), text.data() + text.size());
  }
  std::unique_ptr<custom_flag_formatter> clone() const override {
    return std::make_unique<PrintableText>();
  }
};

std::unique_ptr<spdlog::formatter> line_formatter() {
  auto formatter = std::make_unique<spdlog::pattern_formatter>();
  formatter->add_flag<PrintableText>('*').set_pattern("clpv: %*");
  return formatter;
}

}  // namespace

void set_log_level(bool quiet, int verbosity) {
  static const auto logger = [] {
    auto made =
        std::make_shared<spdlog::logger>("clpv", std::make_shared<spdlog::sinks::stderr_sink_mt>());
    made->set_formatter(line_formatter());
    spdlog::set_default_logger(made);
    return made;
  }();
  logger->set_level(quiet            ? spdlog::level::err
                    : verbosity >= 2 ? spdlog::level::trace
                    : verbosity == 1 ? spdlog::level::debug
                                     : spdlog::level::info);
}

}  // namespace clpv
