// SPDX-License-Identifier: MIT
// Runs the Python package python/clpv/draw, which draws images and pages from JSON, NPY and PNG
// files.
#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <span>
#include <string>
#include <vector>

#include "image/image.hpp"
#include "support/cache_folder.hpp"
#include "support/process.hpp"

namespace clpv {

/// One run of the package: checked before the work, run after it.
class Drawing {
 public:
  /// `kind`: "compare" or "report", the package's file of that name. `asked_by`:
  /// the option or command, for messages. Takes the first interpreter that has the package's
  /// modules: CLPV_PYTHON alone where it is set; else the one found at build time, the first
  /// python3 in PATH, /usr/bin/python3. Throws Error(run_time) with the message of each if none has
  /// them.
  Drawing(std::string kind, std::string asked_by);

  /// Adds a file of the input, of which the destructor leaves nothing.
  void add(const std::string& file, const nlohmann::json& document) const;
  /// Adds an NPY of height x width x channels.
  void add(const std::string& file, std::span<const float> values, int width, int height) const;

  /// Draws into the file `output`. Throws Error(bad_input) for a malformed document,
  /// Error(run_time) with Python's message on failure.
  void draw(const std::filesystem::path& output) const;

 private:
  Process::Result run(const std::filesystem::path& python,
                      const std::vector<std::string>& arguments) const;

  std::string kind_, asked_by_;
  std::filesystem::path python_;
  ScratchFolder scratch_;  ///< the input
};

// Images that commands read.

/// Reads a layer of an image file, and logs what reading converted or ignored. Throws as read_image
/// and extract_layer.
Image read_image_layer(const std::filesystem::path& file, const std::string& layer);

}  // namespace clpv
