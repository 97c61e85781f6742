// SPDX-License-Identifier: MIT
#include "search/normals.hpp"

#include <memory>

#include "cli/options.hpp"
#include "cli/render_request.hpp"
#include "search/normal_weights.hpp"
#include "support/output_file.hpp"

namespace clpv {
namespace normals_command {

struct Options {
  RenderRequest request;
  std::string output;
  double time = 0;
};

void run(const Options& options, const Shared& shared) {
  const std::vector<NamedFile> outputs{{"--output", options.output}};
  check_outputs(outputs);
  MovingScene moving = options.request.open();
  moving.pose(options.time);
  const SceneData& scene = moving.scene();
  const FrameSetup setup = setup_of(options.request, scene);
  check_outputs(outputs);  // now that the inputs are known
  const Device device = choose_device(shared.device);
  Session session(device, ProgramCache::of_user(device));
  write_file(
      options.output,
      to_json(normal_weights(session, scene, scene.camera(options.request.camera), setup.options)));
  session.programs().store();
}

}  // namespace normals_command

void add_normals(CLI::App& app, Shared& shared) {
  using namespace normals_command;
  CLI::App* command =
      app.add_subcommand("normals", "Lit surface normals, weighted by reflected flux");
  auto options = std::make_shared<normals_command::Options>();
  add_render_request(*command, options->request);
  add(*command, "-o,--output", "FILE.json", options->output, "output file, for clpv_lab.search")
      ->required();
  add_seconds(*command, "--time", options->time, "time in the scene's animation [s]");
  command->callback([options, &shared] { run(*options, shared); });
}

}  // namespace clpv
