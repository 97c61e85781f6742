// SPDX-License-Identifier: MIT
#include "bench/row_log.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <nlohmann/json.hpp>

#include "support/error.hpp"

namespace clpv::bench {

RowLog::RowLog(const std::filesystem::path& file) : file_(file) {
  if (file_.empty()) return;
  descriptor_ = ::open(file_.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_APPEND | O_CLOEXEC, 0666);
  if (descriptor_ < 0)
    throw Error(ExitCode::run_time, "{}: cannot be written: {}", file_.string(), std::strerror(errno));
}

RowLog::~RowLog() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

void RowLog::begun(const std::string& name) {
  write(nlohmann::json{{"begun", name}}.dump());
}

void RowLog::done(const Row& row) {
  write(nlohmann::json{{"row", to_json(row, 0)}}.dump());
}

void RowLog::write(const std::string& line) {
  if (descriptor_ < 0) return;
  const std::string whole =
      line + "\n";  // one write a line: the kernel has it, whatever becomes of the process
  if (::write(descriptor_, whole.data(), whole.size()) != static_cast<ssize_t>(whole.size()))
    throw Error(ExitCode::run_time, "{}: cannot be written: {}", file_.string(), std::strerror(errno));
}

}  // namespace clpv::bench
