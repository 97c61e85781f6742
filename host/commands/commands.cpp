// SPDX-License-Identifier: MIT
#include "commands/commands.hpp"

#include <fmt/ranges.h>

#include <algorithm>
#include <optional>

#include "clpv/version.hpp"
#include "commands/manual.hpp"
#include "commands/misspelt.hpp"
#include "parallel/launched.hpp"
#include "parallel/team.hpp"
#include "support/log.hpp"
#include "support/progress.hpp"

namespace clpv {
namespace {

/// An option that prints a text and ends it there, as --version does.
void add_page(CLI::App& app, const std::string& option, const std::function<std::string()>& page) {
  app.add_flag_callback(option, [page] { throw CLI::CallForVersion(page(), 0); })->group("");
}

/// What each rank tells: all of it is rank 0's to tell, what goes wrong any rank's.
void set_talk(const Shared& shared) {
  const std::optional<Launched> started = launched();
  const bool one = !started || started->size == 1;
  const bool others = !one && started->rank > 0 && shared.verbosity == 0 && !shared.quiet;
  set_log_level(shared.quiet, shared.verbosity);
  if (others) spdlog::set_level(spdlog::level::warn);
  if (!one) set_progress_style(started->rank == 0 ? ProgressStyle::lines : ProgressStyle::none);
}

/// Commands that ranks do together; each of them would do all of any other one.
void refuse_ranks_but_to(CLI::App& app, const std::vector<std::string>& names) {
  for (CLI::App* command : app.get_subcommands({})) {
    const std::string name = command->get_name();
    if (std::ranges::count(names, name) > 0) continue;
    command->parse_complete_callback([name, names] {
      const std::optional<Launched> started = launched();
      if (!started || started->size == 1) return;
      throw Error(ExitCode::usage, "{}: not for several processes (found: rank {} of {}); allowed: {}", name,
                  started->rank, started->size ? std::to_string(*started->size) : "some",
                  fmt::join(names, ", "));
    });
  }
}

}  // namespace

Team& Shared::team() {
  if (!begun) {
    const std::optional<Launched> started = launched();
    const bool one = !started || started->size == 1;
    begun = std::make_shared<Team>(one ? Team() : Team(start_messages()));
  }
  return *begun;
}

std::span<const Command> all_commands() {
  static constexpr Command kCommands[] = {
      {"devices", add_devices}, {"render", add_render},       {"sequence", add_sequence},
      {"query", add_query},     {"propagate", add_propagate}, {"check", add_check},
      {"compare", add_compare}, {"reference", add_reference}, {"quality", add_quality},
      {"basis", add_basis},     {"bench", add_bench},         {"report", add_report},
  };
  return kCommands;
}

void add_commands(CLI::App& app, Shared& shared, std::span<const Command> commands) {
  app.description("clpv: cascaded light propagation volumes in OpenCL");
  app.name("clpv");
  app.set_version_flag("--version", "clpv " + version());
  app.add_option("--device", shared.device,
                 "OpenCL device: index, PLATFORM:DEVICE or part of a name (also CLPV_DEVICE)")
      ->type_name("DEVICE");
  app.add_flag("-q,--quiet", shared.quiet, "only data and errors");
  app.add_flag("-v,--verbose", shared.verbosity, "tell more; twice: still more");
  // Hidden: for the installation.
  add_page(app, "--man-page", [&app] { return man_page(app, version()); });
  add_page(app, "--bash-completion", [&app] { return bash_completion(app); });
  app.require_subcommand(1);
  app.fallthrough();
  app.parse_complete_callback([&] { set_talk(shared); });
  for (const Command& command : commands) command.add(app, shared);
  refuse_ranks_but_to(app, {"quality", "sequence", "reference", "bench"});
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
