// SPDX-License-Identifier: MIT
// clpv query: light at points from a file, visible to the camera or not: of the volumes, or
// path-traced.
#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <memory>

#include "basis/basis.hpp"
#include "cli/commands.hpp"
#include "cli/options.hpp"
#include "cli/render_request.hpp"
#include "pathtracer/point_tracer.hpp"
#include "pipeline/frame/cascade.hpp"
#include "pipeline/frame/frame.hpp"
#include "scene/input.hpp"
#include "scene/load.hpp"
#include "support/log.hpp"
#include "support/output_file.hpp"

namespace clpv {
namespace query_command {

struct Options {
  RenderRequest request;
  TracingOptions tracing;
  std::string points, output;
  double time = 0;
  bool truth = false;
  std::vector<CLI::Option*> of_truth = {};  ///< without effect on volumes
};

constexpr std::uint64_t kMaxNumbers = std::uint64_t{1} << 22;  // all points, with --basis

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
    throw Error(ExitCode::usage,
                "--near-field {} has no effect on points; allowed: off, or clpv render",
                near->second);
  }
  if (near->second == name_of(Near::automatic)) near->second = name_of(Near::off);
  return request;
}

/// Throws for options that have no effect with or without --truth.
void reject_without_effect(const Options& options) {
  if (!options.truth) {
    for (const CLI::Option* option : options.of_truth) {
      if (option->count() > 0)
        throw Error(ExitCode::usage, "{} has no effect without --truth", option->get_name());
    }
    return;
  }
  for (const auto& [name, value] : options.request.frame) {
    if (name != "basis")
      throw Error(ExitCode::usage, "--{} has no effect with --truth, which traces paths", name);
  }
}

void append(std::string& text, const glm::dvec3& v) {
  fmt::format_to(std::back_inserter(text), ",{:.7g},{:.7g},{:.7g}", v.x, v.y, v.z);
}

void append_header(std::string& text, const std::string& prefix) {
  for (const char* channel : {"red", "green", "blue"}) text += "," + prefix + channel;
}

/// Projections of the radiance that arrives at the points onto a basis.
pathtracer::TracedProbes projections(const std::vector<SurfacePoint>& points, const Basis& basis,
                                     pathtracer::PointTracer& tracer) {
  const auto n = static_cast<std::size_t>(basis.size());
  if (points.size() * n > kMaxNumbers)
    throw Error(ExitCode::usage, "--basis {}: found {} points, allowed: at most {}", basis.name(),
                points.size(), kMaxNumbers / n);
  std::vector<glm::dvec3> positions;
  for (const SurfacePoint& point : points)
    positions.push_back(point.position + tracer.surface_distance() * point.normal);
  const pathtracer::Moments moments{n, [&basis](const glm::dvec3& w, std::span<double> g) {
                                      std::ranges::copy(basis.gram_inverse() * basis.evaluate(w),
                                                        g.begin());
                                    }};
  Progress progress("tracing radiance", kTraceSteps);
  return tracer.probes(positions, moments, 0, 0, trace_progress(progress));
}

std::string truth_of(const Options& options, const std::vector<SurfacePoint>& points,
                     const SceneData& scene, const SceneCamera& camera) {
  if (points.size() > pathtracer::kMaxTracedPoints)
    throw Error(ExitCode::bad_input, "{}: found {} points, allowed with --truth: at most {}",
                options.points, points.size(), pathtracer::kMaxTracedPoints);
  const auto lights = scene.lights_for(camera);
  pathtracer::PointTracer tracer(scene, lights, options.tracing.resolved());
  Progress progress("tracing irradiance", kTraceSteps);
  const pathtracer::TracedPoints traced = tracer.irradiance(points, trace_progress(progress));
  std::unique_ptr<Basis> basis;
  pathtracer::TracedProbes projected;
  if (const auto name = options.request.frame.find("basis"); name != options.request.frame.end()) {
    basis = make_basis(name->second);
    projected = projections(points, *basis, tracer);
  }
  std::string text = "x,y,z,nx,ny,nz";
  for (const char* prefix : {"", "direct_", "error_"}) append_header(text, prefix);
  for (int i = 0; basis && i < basis->size(); ++i) append_header(text, fmt::format("c{}_", i));
  for (std::size_t i = 0; i < points.size(); ++i) {
    const auto& [p, n] = points[i];
    fmt::format_to(std::back_inserter(text), "\n{},{},{},{},{},{}", p.x, p.y, p.z, n.x, n.y, n.z);
    const pathtracer::PointLight& light = traced.points[i];
    for (const glm::dvec3& value : {light.indirect, light.direct, light.error}) append(text, value);
    for (int k = 0; basis && k < basis->size(); ++k)
      append(text, projected.indirect[i * static_cast<std::size_t>(basis->size()) + k]);
  }
  log_info("{} paths per point, noise {:.4f}", traced.samples, traced.noise);
  return text + "\n";
}

std::string light_of_volumes(const Options& options, const std::vector<SurfacePoint>& points,
                             const SceneData& scene, const SceneCamera& camera,
                             const Shared& shared) {
  const RenderRequest request = of_volumes(options.request);
  const FrameSetup setup = setup_of(request, scene);
  log_scene(scene, camera, setup.options);
  const Device device = choose_device(shared.device);
  Session session(device, ProgramCache::of_user(device),
                  compilation_of(request, setup.options, shared.device));
  Frame frame(session, scene, setup);
  frame.render(camera);
  std::string table = table_of(points, frame);
  session.programs().store();
  return table;
}

void run(const Options& options, const Shared& shared) {
  reject_without_effect(options);
  const std::vector<NamedFile> outputs{{"--output", options.output}};
  check_outputs(outputs);
  const std::vector<SurfacePoint> points = read_points(options.points);
  MovingScene moving = options.request.open();
  moving.pose(options.time);
  check_outputs(outputs);
  const SceneData& scene = moving.scene();
  const SceneCamera& camera = scene.camera(options.request.camera);
  const std::string table = options.truth
                                ? truth_of(options, points, scene, camera)
                                : light_of_volumes(options, points, scene, camera, shared);
  if (options.output.empty()) {
    print_text(table);
  } else {
    write_file(options.output, table);
  }
}

}  // namespace query_command

void add_query(CLI::App& app, Shared& shared) {
  using namespace query_command;
  CLI::App* command = app.add_subcommand(
      "query", "Compute light at points from a file, visible to the camera or not");
  auto options = std::make_shared<query_command::Options>();
  add(*command, "--points", "FILE.csv", options->points,
      "input points, lines of x,y,z,nx,ny,nz: world position [m] and surface normal")
      ->required();
  add(*command, "-o,--output", "FILE.csv", options->output,
      "output table, as CSV (default: stdout)");
  add_seconds(*command, "--time", options->time, "time in the scene's animation [s]");
  command->add_flag("--truth", options->truth,
                    "path-traced light, in place of the volumes': indirect, direct, and the "
                    "standard error of indirect light");
  add_tracing_options(*command, options->tracing);
  CLI::Option* bounces = command->get_option("--bounces");
  for (const char* name : {"--spp", "--noise", "--seed", "--threads"})
    options->of_truth.push_back(command->get_option(name));
  add_point_request(*command, options->request);
  command->footer(
      "Adds red,green,blue to each point: the irradiance of indirect light on a surface there "
      "[W/m^2], like --view\nirradiance with --near-field off. Outside the cascades, which "
      "surround the "
      "camera, it is 0. The surface need not be part of\nthe scene: it can be a moving object or "
      "mist. --truth traces paths, wherever the points lie, and also adds\n"
      "direct_red... and error_red...; with --basis also c0_red..., the projection of the radiance "
      "that arrives.");
  command->callback([options, bounces, &shared] {
    if (!options->truth && bounces->count() > 0)
      options->request.frame["bounces"] = options->tracing.bounces;
    run(*options, shared);
  });
}

}  // namespace clpv
