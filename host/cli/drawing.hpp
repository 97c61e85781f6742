// SPDX-License-Identifier: MIT
// Runs the Python package python/clpv/draw, which draws images and pages from JSON, NPY and PNG files.
#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

namespace clpv {

/// One run of the package: checked before the work, run after it.
class Drawing {
 public:
  /// `kind`: "bench", "basis" or "report", the package's file of that name.
  /// `asked_by`: the option or command, for messages.
  /// Throws Error(run_time) with Python's message if it or a module is missing.
  Drawing(std::string kind, std::string asked_by);
  ~Drawing();
  Drawing(const Drawing&) = delete;
  Drawing& operator=(const Drawing&) = delete;

  /// Temporary folder for the input; removed by the destructor.
  const std::filesystem::path& folder() const { return folder_; }
  void add(const std::string& file, const nlohmann::json& document) const;

  /// Throws Error(bad_input) for a malformed document, Error(run_time) with Python's message on failure.
  void draw(const std::filesystem::path& output) const;

 private:
  void run(const std::vector<std::string>& arguments) const;

  std::string kind_, asked_by_;
  std::filesystem::path folder_;
};

}  // namespace clpv
