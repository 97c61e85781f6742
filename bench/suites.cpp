// SPDX-License-Identifier: MIT
// The list of suites, and helpers that they share.

#include "bench/suites.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "options/render_options.hpp"
#include "scene/scene.hpp"

namespace clpv::bench {

const std::vector<Suite>& suites() {
  static const std::vector<Suite> all = {table1_suite(), layouts_suite(), bases_suite(),
                                         frame_suite()};
  return all;
}

Problem basis_problem(const SuiteOptions& options, const std::string& basis) {
  Problem problem;
  problem.options = options.settings;
  problem.options.basis = basis;
  return problem;
}

RenderOptions published_options(const RenderOptions& sizes, const std::string& basis) {
  RenderOptions options;
  apply_preset(options, PresetName::paper);
  options.basis = basis;
  options.grid = sizes.grid, options.iterations = sizes.iterations;
  options.cascades = sizes.cascades, options.cascade_size = sizes.cascade_size;
  options.rsm_size = sizes.rsm_size;
  options.width = sizes.width, options.height = sizes.height;
  return options;
}

std::vector<Row> pass_rows(const FrameTimes& times, const Row& frame) {
  std::vector<Row> rows;
  for (const auto& [pass, ms] : times.passes()) {
    Row row = frame;
    row.stage = pass;
    row.name = pass + frame.name.substr(frame.name.find('/'));
    row.samples_ms = ms;
    row.times = statistics_of(ms);
    row.wall_ms = row.cpu_ms = row.first_launch_ms = row.build_ms = 0;
    row.from_events = times.from_events();
    row.max_rel_error.reset();  // the frame's error is that of the image, not of a pass
    row.host = {};
    rows.push_back(std::move(row));
  }
  return rows;
}

std::string error_text(const Row& row) {
  return row.max_rel_error ? fmt::format("{:.1e}", *row.max_rel_error) : "-";
}

std::size_t name_width(const std::vector<Row>& rows) {
  std::size_t width = 4;
  for (const Row& row : rows) width = std::max(width, row.name.size());
  return width;
}

std::string row_lines(const std::vector<Row>& rows, std::size_t width,
                      const std::function<std::string(const Row&)>& columns) {
  std::string text;
  for (const Row& row : rows) {
    const bool timed = row.status == Status::ok || row.status == Status::wrong;
    text +=
        fmt::format("{:<{}} {}{}\n", row.name, width,
                    timed ? columns(row) : fmt::format("{}: {}", name_of(row.status), row.reason),
                    row.status == Status::wrong ? "  WRONG: " + row.reason : "");
  }
  return text;
}

std::shared_ptr<Bench> make_bench(Session& session, const SuiteOptions& options,
                                  const RenderOptions& settings) {
  const auto make_inputs = [&session, options, settings] {
    return std::make_shared<Inputs>(session, *options.scene, options.scene->camera(options.camera),
                                    settings);
  };
  return std::make_shared<Bench>(Bench{session, make_inputs, {}, {}});
}

}  // namespace clpv::bench
