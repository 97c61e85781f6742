// SPDX-License-Identifier: MIT
// The suites of `clpv bench`: the cases and the table of each.
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "bench/stage_jobs.hpp"
#include "scene/scene.hpp"
#include "times/frame_times.hpp"

namespace clpv::bench {

/// Scene, camera, bases and settings for a suite.
struct SuiteOptions {
  std::shared_ptr<const SceneData> scene;
  std::string camera;              ///< by name; empty: the scene's first
  std::vector<std::string> bases;  ///< empty: the suite's default bases
  /// Settings of all rows, apart from those that the suite varies.
  RenderOptions settings = timed_options();
};

/// Cases that are timed interleaved with each other. Groups run one after another, and each
/// releases its memory.
using Group = std::vector<Case>;

struct Suite {
  std::string name, help;
  std::function<std::vector<Group>(Session&, const SuiteOptions&)> groups;
  /// Formats the rows as a table; null: report_table().
  std::function<std::string(const std::vector<Row>&)> table;
};

const std::vector<Suite>& suites();

// Defined in suites/NAME.cpp.
Suite table1_suite();
Suite layouts_suite();
Suite bases_suite();
Suite frame_suite();

/// The suite's settings with `basis`.
Problem basis_problem(const SuiteOptions& options, const std::string& basis);

/// The paper's settings (`--preset paper`) with `basis`, and sizes and cascades from `sizes`.
RenderOptions published_options(const RenderOptions& sizes, const std::string& basis);

/// A row for each pass of timed frames: the row of the frame with the times of the pass.
std::vector<Row> pass_rows(const FrameTimes& times, const Row& frame);

/// The row's error for a table, "-" if nothing was compared.
std::string error_text(const Row& row);

/// Length of the longest row name, at least 4.
std::size_t name_width(const std::vector<Row>& rows);
/// Text with one line per row: the name padded to `width`, then `columns` of a timed row, or status
/// and reason.
std::string row_lines(const std::vector<Row>& rows, std::size_t width,
                      const std::function<std::string(const Row&)>& columns);

/// A Bench whose inputs are rasterised from the scene of `options` with `settings`.
std::shared_ptr<Bench> make_bench(Session& session, const SuiteOptions& options,
                                  const RenderOptions& settings);

}  // namespace clpv::bench
