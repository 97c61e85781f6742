// SPDX-License-Identifier: MIT
// Pictures and pages are drawn by the Python package tools/clpv_draw, from JSON, NPY and PNG files that commands write.
#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>

namespace clpv {

/// What is drawn, and from which files in the drawing's folder; the package's files of the same names tell more.
enum class Picture {
  bench,   ///< charts into a folder, of bench.json
  basis,   ///< the paper's figures into a folder, of figures.json and surfaces.npy
  report,  ///< a page into a file, of report.json and the images it names
};

/// One run of the package: looked for before the work, run after it.
class Drawing {
 public:
  /// Finds the package, beside the installed program or where it was built, and the first python3 of the path that has
  /// the modules it needs. `asked_by`: the option or command, for messages. Throws Error(run_time) that says what is
  /// missing and which package of Debian has it.
  Drawing(Picture picture, std::string asked_by);
  ~Drawing();
  Drawing(const Drawing&) = delete;
  Drawing& operator=(const Drawing&) = delete;

  /// Where the input goes; gone with this object.
  const std::filesystem::path& folder() const { return folder_; }
  void add(const std::string& file, const nlohmann::json& document) const;

  /// Throws Error(bad_input) where a document is not of its shape, Error(run_time) with Python's last words where it fails.
  void draw(const std::filesystem::path& output) const;

 private:
  Picture picture_;
  std::string asked_by_;
  std::filesystem::path package_, python_, folder_;
};

}  // namespace clpv
