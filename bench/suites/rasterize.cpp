// SPDX-License-Identifier: MIT
// Suite `rasterize`: G-buffer, shadow maps and RSMs, beside a peer that draws the same.
#include <fmt/format.h>

#include <algorithm>

#include "bench/suites.hpp"

namespace clpv::bench {
namespace {

constexpr Pass kPasses[] = {Pass::rasterize_camera, Pass::rasterize_shadow, Pass::rasterize_rsm};

std::vector<Case> cases(Session& session, const SuiteOptions& options, const RasterPeer& peer) {
  std::vector<Case> cases;
  const auto scene = scene_of(options);
  const auto add = [&](Pass pass, const std::string& suffix, std::function<Job()> make) {
    Case added;
    added.row.suite = "rasterize", added.row.stage = name_of(pass);
    added.row.name = std::string(name_of(pass)) + suffix;
    added.make = std::move(make);
    cases.push_back(std::move(added));
  };
  for (const Pass pass : kPasses) {
    add(pass, "", [&session, scene, pass, options] {
      return rasterize_job(session, scene, options.camera, pass, options.settings);
    });
    if (!peer.job) continue;
    add(pass, "/" + peer.name, [scene, pass, options, peer] {
      return peer.job(make_task(scene, options.camera, pass, options.settings));
    });
  }
  return cases;
}

/// Wall time of the row `name` [ms]; 0 without such a row.
double wall_ms_of(const std::vector<Row>& rows, const std::string& name) {
  const auto row = std::ranges::find(rows, name, &Row::name);
  return row == rows.end() || row->status == Status::unsupported ? 0 : row->wall_ms;
}

std::string rasterize_table(const std::vector<Row>& rows, const RasterPeer& peer) {
  constexpr std::size_t kWidth = 28;
  std::string text = fmt::format("{:<{}} {:>10} {:>9} {:>14} {:>12} {:>9}", "row", kWidth,
                                 "wall ms", "mad", "M triangles/s", "ns/triangle", "ns/pixel");
  if (peer.job) text += fmt::format(" {:>14}", peer.name + " / clpv");
  return text + "\n" + row_lines(rows, kWidth, [&](const Row& row) {
           const double peer_ms = peer.job ? wall_ms_of(rows, row.name + "/" + peer.name) : 0;
           return fmt::format("{:>10.2f} {:>9.2f} {:>14.1f} {:>12.1f} {:>9.1f}", row.wall_ms,
                              row.times.mad, row.cost.triangles / row.wall_ms * 1e-3,
                              row.wall_ms * 1e6 / row.cost.triangles,
                              row.wall_ms * 1e6 / row.cost.pixels) +
                  (peer_ms > 0 ? fmt::format(" {:>14.2f}", peer_ms / row.wall_ms) : "");
         });
}

}  // namespace

Suite rasterize_suite(const RasterPeer& peer) {
  return {peer.job ? "rasterize-" + peer.name : "rasterize",
          fmt::format("G-buffer, shadow maps and RSMs: time per triangle and per pixel{}",
                      peer.job ? ", compared with " + peer.name : ""),
          [peer](Session& session, const SuiteOptions& options) {
            return std::vector<Group>{
                {[&session, options, peer] { return cases(session, options, peer); }}};
          },
          [peer](const std::vector<Row>& rows) { return rasterize_table(rows, peer); }};
}

}  // namespace clpv::bench
