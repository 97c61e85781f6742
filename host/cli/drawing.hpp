// SPDX-License-Identifier: MIT
// Pictures and pages are drawn by the Python package tools/clpv_draw, from JSON, NPY and PNG files that commands write.
#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

namespace clpv {

/// One run of the package: tried before the work, run after it.
class Drawing {
 public:
  /// `kind`: "bench", "basis" or "report", the package's file of that name; `asked_by`: the option or command, for messages.
  /// Throws Error(run_time) with Python's words where it or a module is missing.
  Drawing(std::string kind, std::string asked_by);
  ~Drawing();
  Drawing(const Drawing&) = delete;
  Drawing& operator=(const Drawing&) = delete;

  /// Where the input goes; gone with this object.
  const std::filesystem::path& folder() const { return folder_; }
  void add(const std::string& file, const nlohmann::json& document) const;

  /// Throws Error(bad_input) where a document is not of its shape, Error(run_time) with Python's words where it fails.
  void draw(const std::filesystem::path& output) const;

 private:
  void run(const std::vector<std::string>& arguments) const;

  std::string kind_, asked_by_;
  std::filesystem::path folder_;
};

}  // namespace clpv
