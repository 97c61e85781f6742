// SPDX-License-Identifier: MIT
// What happens to rows, a line of JSON each, written as it happens: what a crash leaves.
#pragma once

#include <filesystem>
#include <string>

#include "bench/row.hpp"

namespace clpv::bench {

class RowLog {
 public:
  /// Empties the file. Throws Error(run_time) where it cannot be written. No file: nothing is kept.
  explicit RowLog(const std::filesystem::path& file);
  ~RowLog();
  RowLog(const RowLog&) = delete;
  RowLog& operator=(const RowLog&) = delete;

  /// {"begun": NAME}: it is being made ready; the last one without its {"row": ...} is what a crash was in.
  void begun(const std::string& name);
  /// {"row": ...}: done, as in the report.
  void done(const Row& row);

 private:
  void write(const std::string& line);

  std::filesystem::path file_;
  int descriptor_ = -1;
};

}  // namespace clpv::bench
