// SPDX-License-Identifier: MIT
// The suites of `clpv bench`: which rows each has, and what its table looks like.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "bench/ceilings.hpp"
#include "bench/stage_jobs.hpp"
#include "scene/scene.hpp"

namespace clpv::bench {

/// What a suite is asked to do.
struct SuiteOptions {
  std::shared_ptr<const Scene> scene;  ///< none: the hall of hall.hpp
  std::string camera;
  std::vector<std::string> bases;            ///< named by the user; empty: the suite's own
  RenderOptions settings = timed_options();  ///< of every row, but for what the suite varies
};

/// Cases that are timed interleaved with each other. Groups follow one another, each releasing its memory first.
using Group = std::function<std::vector<Case>()>;

struct Suite {
  std::string name, help;
  std::function<std::vector<Group>(Session&, const SuiteOptions&)> groups;
  /// The rows as text; the plain table (report.hpp) where there is none.
  std::function<std::string(const std::vector<Row>&)> table;
  /// Scene file, from the project's folder, that it works on where none is given; empty: the hall.
  std::string usual_scene = {};
};

const std::vector<Suite>& suites();

// Each in suites/NAME.cpp, that of the ceilings in ceilings.cpp.
Suite table1_suite();
Suite layouts_suite();
Suite bases_suite();
Suite scaling_suite();
Suite ceilings_suite();
Suite frame_suite();
Suite baseline_suite();
Suite rasterize_suite();
Suite regression_suite();

/// A basis with all else as the options say or by default.
Variant plain_variant(const SuiteOptions& options, const std::string& basis);

/// The paper's settings and way (`--preset paper`) for a basis, of the sizes and cascades of `sizes`.
RenderOptions published_options(const RenderOptions& sizes, const std::string& basis);

/// A group a basis, by `cases`: all of them at once would hold gigabytes.
std::vector<Group> group_a_basis(const std::vector<std::string>& bases,
                                 const std::function<std::vector<Case>(const std::string& basis)>& cases);

/// The length of the longest name.
std::size_t name_width(const std::vector<Row>& rows);
/// A line a row, names `width` wide: `columns` of one that was timed, and whether it is wrong; else why it was not.
std::string row_lines(const std::vector<Row>& rows, std::size_t width,
                      const std::function<std::string(const Row&)>& columns);

/// The scene a suite works on: the one given, else the hall.
std::shared_ptr<const Scene> scene_of(const SuiteOptions& options);
std::shared_ptr<Bench> make_bench(Session& session, const SuiteOptions& options,
                                  const RenderOptions& settings);

}  // namespace clpv::bench
