// SPDX-License-Identifier: MIT
// Parses, calls a command, turns an error into an exit code; nothing else.
#include <CL/opencl.hpp>
#include <iostream>

#include "commands/commands.hpp"
#include "commands/misspelt.hpp"
#include "device/cl_error.hpp"
#include "support/error.hpp"
#include "support/log.hpp"

namespace {

void parse(CLI::App& app, int argc, char** argv) {
  try {
    app.parse(argc, argv);
  } catch (const CLI::RequiredError&) {
    if (app.get_subcommands().empty()) clpv::refuse_misspelt_command(app);
    throw;
  }
}

}  // namespace

int main(int argc, char** argv) {
  using namespace clpv;
  CLI::App app{"clpv: cascaded light propagation volumes in OpenCL", "clpv"};
  Shared shared;
  app.set_version_flag("--version", std::string("clpv ") + CLPV_VERSION);
  app.add_option("--device", shared.device,
                 "OpenCL device: index, PLATFORM:DEVICE or part of a name (also CLPV_DEVICE)")
      ->type_name("DEVICE");
  app.add_flag("-q,--quiet", shared.quiet, "only data and errors");
  app.add_flag("-v,--verbose", shared.verbosity, "tell more; twice: still more");
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
  if (argc == 1) {
    std::cout << app.help();
    return 0;
  }
  try {
    parse(app, argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error, std::cout, std::cerr) == 0 ? 0 : static_cast<int>(ExitCode::usage);
  } catch (const Error& error) {
    std::cerr << "clpv: " << error.what() << '\n';
    return static_cast<int>(error.code());
  } catch (const cl::Error& error) {
    const Error named = cl_error(error);
    std::cerr << "clpv: " << named.what() << '\n';
    return static_cast<int>(named.code());
  } catch (const std::bad_alloc&) {
    std::cerr << "clpv: out of memory\n";
    return static_cast<int>(ExitCode::run_time);
  } catch (const std::exception& error) {
    std::cerr << "clpv: " << error.what() << '\n';
    return static_cast<int>(ExitCode::run_time);
  }
  return 0;
}
