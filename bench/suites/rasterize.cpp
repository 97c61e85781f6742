// SPDX-License-Identifier: MIT
// Suite `rasterize`: G-buffer, shadow maps and RSMs by clpv, and the same work by OpenGL ES.
#include "pipeline/raster/rasterize.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "bench/suites.hpp"

namespace clpv::bench {
namespace {

constexpr const char* kOpenGl = "/opengl";
constexpr Pass kPasses[] = {Pass::rasterize_camera, Pass::rasterize_shadow, Pass::rasterize_rsm};

std::vector<Case> cases(Session& session, const SuiteOptions& options) {
  std::vector<Case> cases;
  const auto scene = scene_of(options);
  for (const Pass pass : kPasses) {
    for (const bool opengl : {false, true}) {
      Case added;
      added.row.suite = "rasterize", added.row.stage = name_of(pass);
      added.row.name = std::string(name_of(pass)) + (opengl ? kOpenGl : "");
      added.make = [&session, scene, pass, camera = options.camera, settings = options.settings,
                    make = opengl ? rasterize_gl_job : rasterize_job] {
        return make(session, scene, camera, pass, settings);
      };
      cases.push_back(std::move(added));
    }
  }
  return cases;
}

/// Wall time of the row `name` [ms]; 0 without such a row.
double wall_ms_of(const std::vector<Row>& rows, const std::string& name) {
  const auto row = std::ranges::find(rows, name, &Row::name);
  return row == rows.end() || row->status == Status::unsupported ? 0 : row->wall_ms;
}

std::string rasterize_table(const std::vector<Row>& rows) {
  constexpr std::size_t kWidth = 28;
  const std::string text =
      fmt::format("{:<{}} {:>10} {:>9} {:>14} {:>12} {:>9} {:>14}\n", "row", kWidth, "wall ms",
                  "mad", "M triangles/s", "ns/triangle", "ns/pixel", "opengl / clpv");
  return text + row_lines(rows, kWidth, [&](const Row& row) {
           const double opengl_ms = wall_ms_of(rows, row.name + kOpenGl);
           return fmt::format("{:>10.2f} {:>9.2f} {:>14.1f} {:>12.1f} {:>9.1f} {:>14}", row.wall_ms,
                              row.times.mad, row.cost.triangles / row.wall_ms * 1e-3,
                              row.wall_ms * 1e6 / row.cost.triangles,
                              row.wall_ms * 1e6 / row.cost.pixels,
                              opengl_ms > 0 ? fmt::format("{:.2f}", opengl_ms / row.wall_ms) : "-");
         });
}

}  // namespace

Suite rasterize_suite() {
  return {
      "rasterize",
      "G-buffer, shadow maps and RSMs: time per triangle and per pixel, compared with OpenGL ES",
      [](Session& session, const SuiteOptions& options) {
        return std::vector<Group>{{[&session, options] { return cases(session, options); }}};
      },
      rasterize_table};
}

}  // namespace clpv::bench
