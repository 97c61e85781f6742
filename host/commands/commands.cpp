// SPDX-License-Identifier: MIT
#include "commands/commands.hpp"

#include "commands/manual.hpp"
#include "commands/misspelt.hpp"
#include "support/log.hpp"

namespace clpv {
namespace {

/// An option that prints a text and ends it there, as --version does.
void add_page(CLI::App& app, const std::string& option, const std::function<std::string()>& page) {
  app.add_flag_callback(option, [page] { throw CLI::CallForVersion(page(), 0); })->group("");
}

}  // namespace

void add_commands(CLI::App& app, Shared& shared) {
  app.description("clpv: cascaded light propagation volumes in OpenCL");
  app.name("clpv");
  app.set_version_flag("--version", std::string("clpv ") + CLPV_VERSION);
  app.add_option("--device", shared.device,
                 "OpenCL device: index, PLATFORM:DEVICE or part of a name (also CLPV_DEVICE)")
      ->type_name("DEVICE");
  app.add_flag("-q,--quiet", shared.quiet, "only data and errors");
  app.add_flag("-v,--verbose", shared.verbosity, "tell more; twice: still more");
  // Hidden: for the installation.
  add_page(app, "--man-page", [&app] { return man_page(app, CLPV_VERSION); });
  add_page(app, "--bash-completion", [&app] { return bash_completion(app); });
  app.require_subcommand(1);
  app.fallthrough();
  app.parse_complete_callback([&] { set_log_level(shared.quiet, shared.verbosity); });
  add_devices(app, shared);
  add_render(app, shared);
  add_sequence(app, shared);
  add_query(app, shared);
  add_propagate(app, shared);
  add_check(app, shared);
  add_compare(app, shared);
  add_reference(app, shared);
  add_quality(app, shared);
  add_basis(app, shared);
  add_bench(app, shared);
  add_tune(app, shared);
  add_report(app, shared);
  app.footer(
      "Exit codes: 0 ok; 1 run-time failure (device memory, unwritable output); 2 usage; 3 bad scene or "
      "image file;\n"
      "4 no device, or one that lacks what was asked; 5 validation failed. stdout is data, stderr is talk.");
}

void parse_command_line(CLI::App& app, int argc, char** argv) {
  try {
    app.parse(argc, argv);
  } catch (const CLI::RequiredError&) {
    if (app.get_subcommands().empty()) refuse_misspelt_command(app);
    throw;
  }
}

}  // namespace clpv
