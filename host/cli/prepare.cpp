// SPDX-License-Identifier: MIT
// clpv prepare: a helper process, which compiles kernels of a frame that another process is about
// to render.
#include <memory>

#include "cli/commands.hpp"
#include "cli/render_request.hpp"
#include "pipeline/frame/frame.hpp"
#include "scene/load.hpp"
#include "scene/motion.hpp"
#include "support/helpers.hpp"

namespace clpv {
namespace prepare_command {

struct Options {
  RenderRequest request;
  std::string claims;
};

/// Does everything that rendering does, but launches only the kernels of claimed programs.
void run(const Options& options, const Shared& shared) {
  become_helper();
  MovingScene moving = options.request.open();
  moving.pose(0);
  Session session(choose_device(shared.device), std::nullopt, {{}, Claims(options.claims)});
  Frame frame(session, moving.scene(), FrameSetup(options.request.frame, moving.scene()));
  frame.render(moving.scene().camera(options.request.camera));
  session.programs().mark_compiled();
}

}  // namespace prepare_command

void add_prepare(CLI::App& app, Shared& shared) {
  using namespace prepare_command;
  CLI::App* command =
      app.add_subcommand("prepare", "Compile kernels, as a helper of another process");
  command->group("");  // not for users
  auto options = std::make_shared<prepare_command::Options>();
  add_render_request(*command, options->request);
  add(*command, "--claims", "DIR", options->claims, "folder shared with other helpers")->required();
  command->callback([options, &shared] { run(*options, shared); });
}

}  // namespace clpv
