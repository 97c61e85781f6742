// SPDX-License-Identifier: MIT
// Suite `rasterize`: the camera's view, a light's shadow map and its reflective shadow maps, beside the same by OpenGL in the
// same run.
#include "pipeline/rasterize.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "bench/suites.hpp"

namespace clpv::bench {
namespace {

constexpr const char* kPeer = "/opengl";
constexpr Pass kPasses[] = {Pass::rasterize_camera, Pass::rasterize_shadow, Pass::rasterize_rsm};

std::vector<Case> cases(Session& session, const SuiteOptions& options) {
  std::vector<Case> cases;
  const auto scene = scene_of(options);
  for (const Pass pass : kPasses) {
    for (const bool peer : {false, true}) {
      Case made;
      made.row.suite = "rasterize", made.row.stage = name_of(pass);
      made.row.name = std::string(name_of(pass)) + (peer ? kPeer : "");
      made.make = [&session, scene, pass, camera = options.camera, settings = options.settings,
                   make = peer ? rasterize_gl_job : rasterize_job] {
        return make(session, scene, camera, pass, settings);
      };
      cases.push_back(std::move(made));
    }
  }
  return cases;
}

/// By the host's clock, which OpenGL is timed by.
double wall_of(const std::vector<Row>& rows, const std::string& name) {
  const auto found = std::ranges::find(rows, name, &Row::name);
  return found == rows.end() || found->status == Status::unsupported ? 0 : found->wall_ms;
}

std::string rasterize_table(const std::vector<Row>& rows) {
  constexpr std::size_t kWidth = 28;
  const std::string text =
      fmt::format("{:<{}} {:>10} {:>9} {:>14} {:>12} {:>9} {:>14}\n", "row", kWidth, "wall ms", "mad",
                  "M triangles/s", "ns/triangle", "ns/pixel", "opengl / clpv");
  return text + row_lines(rows, kWidth, [&](const Row& row) {
           const double peer = wall_of(rows, row.name + kPeer);
           return fmt::format("{:>10.2f} {:>9.2f} {:>14.1f} {:>12.1f} {:>9.1f} {:>14}", row.wall_ms,
                              row.times.mad, row.cost.triangles / row.wall_ms * 1e-3,
                              row.wall_ms * 1e6 / row.cost.triangles, row.wall_ms * 1e6 / row.cost.pixels,
                              peer > 0 ? fmt::format("{:.2f}", peer / row.wall_ms) : "-");
         });
}

}  // namespace

Suite rasterize_suite() {
  return {"rasterize",
          "the camera's view, shadow map and RSMs: a triangle, a pixel, and against OpenGL (llvmpipe)",
          [](Session& session, const SuiteOptions& options) {
            return std::vector<Group>{{[&session, options] { return cases(session, options); }}};
          },
          rasterize_table};
}

}  // namespace clpv::bench
