// SPDX-License-Identifier: MIT
// clpv query: indirect light of the volumes at points from a file, visible to the camera or not.
#include <fmt/format.h>

#include <iterator>

#include "cli/commands.hpp"
#include "cli/options.hpp"
#include "cli/render_request.hpp"
#include "pipeline/frame/cascade.hpp"
#include "pipeline/frame/frame.hpp"
#include "scene/load.hpp"
#include "scene/points_file.hpp"
#include "support/log.hpp"
#include "support/output_file.hpp"
#include "support/print.hpp"

namespace clpv {
namespace query_command {

struct Options {
  RenderRequest request;
  std::string points, output;
  double time = 0;
};

std::string table_of(const std::vector<SurfacePoint>& points, Frame& frame) {
  std::vector<glm::vec4> positions, normals;
  for (const auto& [p, n] : points) {
    positions.emplace_back(glm::vec3(p), 0);
    normals.emplace_back(glm::vec3(n), 0);
  }
  const std::vector<glm::vec4> light =
      frame.irradiance_at(std::move(positions), std::move(normals));
  const ClpvGrid coarsest = frame.light().grids.back();
  std::string text = "x,y,z,nx,ny,nz,red,green,blue\n";
  std::size_t outside = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const auto& [p, n] = points[i];
    outside += !reaches(coarsest, p);
    fmt::format_to(std::back_inserter(text), "{},{},{},{},{},{},{},{},{}\n", p.x, p.y, p.z, n.x,
                   n.y, n.z, light[i].x, light[i].y, light[i].z);
  }
  if (outside > 0)
    log_warning("{} of {} points lie outside the cascades, where there is no light", outside,
                points.size());
  return text;
}

/// The request without near field, which only pixels of a camera have.
RenderRequest of_volumes(RenderRequest request) {
  const auto [near, added] = request.frame.emplace("near", "off");
  if (!added && near->second == name_of(Near::traced)) {
    throw Error(ExitCode::usage, "--near {} has no effect on points; allowed: off, or clpv render",
                near->second);
  }
  if (near->second == name_of(Near::automatic)) near->second = name_of(Near::off);
  return request;
}

void run(const Options& options, const Shared& shared) {
  const std::vector<NamedFile> outputs{{"--output", options.output}};
  check_outputs(outputs);
  const std::vector<SurfacePoint> points = read_points(options.points);
  const RenderRequest request = of_volumes(options.request);
  MovingScene moving = request.open();
  moving.pose(options.time);
  const RenderOptions resolved = resolve_request(request, moving.scene());
  check_outputs(outputs);
  const SceneCamera& camera = moving.scene().camera(request.camera);
  log_scene(moving.scene(), camera, resolved);
  const Device device = choose_device(shared.device);
  Session session(device, ProgramCache::of_user(device), compilation_of(request, shared.device));
  Frame frame(session, moving.scene(), resolved);
  frame.render(camera);
  const std::string table = table_of(points, frame);
  if (options.output.empty()) {
    print_text(table);
  } else {
    write_file(options.output, table);
  }
  session.store_programs();
}

}  // namespace query_command

void add_query(CLI::App& app, Shared& shared) {
  using namespace query_command;
  CLI::App* command = app.add_subcommand(
      "query", "Compute indirect light at points from a file, visible to the camera or not");
  auto options = std::make_shared<query_command::Options>();
  add(*command, "--points", "FILE.csv", options->points,
      "input points, lines of x,y,z,nx,ny,nz: world position [m] and surface normal")
      ->required();
  add(*command, "-o,--output", "FILE.csv", options->output,
      "output table, as CSV (default: stdout)");
  add_seconds(*command, "--time", options->time, "time in the scene's animation [s]");
  add_render_request(*command, options->request);
  command->footer(
      "Adds red,green,blue to each point: the irradiance of indirect light on a surface there "
      "[W/m^2], like --view\nirradiance with --near off. Outside the cascades, which surround the "
      "camera, it is 0. The surface need not be part of\nthe scene: it can be a moving object or "
      "mist.");
  command->callback([options, &shared] { run(*options, shared); });
}

}  // namespace clpv
