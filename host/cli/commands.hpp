// SPDX-License-Identifier: MIT
// The sub-commands. Each adds its options, help and callback to the program.
#pragma once

#include <CLI/CLI.hpp>
#include <memory>
#include <span>
#include <string>

#include "cli/additions.hpp"
#include "cli/program_main.hpp"
#include "parallel/ranks.hpp"

namespace clpv {

/// State shared by all commands.
struct Shared {
  std::string device;  ///< --device
  bool quiet = false;
  bool verbose = false;
  Additions additions;
  /// Returns the ranks of the launcher that started this process; the first call starts MPI.
  Ranks& ranks();
  std::unique_ptr<Ranks> started;  ///< null before the first call
};

struct Command {
  const char *name, *group;  ///< group: in --help
  void (*add)(CLI::App& app, Shared& shared);
};

/// All commands, in the order of --help.
std::span<const Command> all_commands();

/// Adds the program's description, the shared options and the commands.
void add_commands(CLI::App& app, Shared& shared,
                  std::span<const Command> commands = all_commands());

/// Parses and runs the command. Throws CLI::Error, and Error(usage) that suggests the closest
/// command.
void parse_command_line(CLI::App& app, int argc, const char* const* argv);

/// The program without signal handling: parses, runs the command and logs errors to stderr. Returns
/// the exit code. A failing rank aborts all ranks.
int run_program(int argc, const char* const* argv, const Additions& additions = {});

// Each command is in cli/NAME.cpp. The callbacks throw clpv::Error; run_program turns it into an
// exit code.
void add_devices(CLI::App& app, Shared& shared);
void add_render(CLI::App& app, Shared& shared);
void add_sequence(CLI::App& app, Shared& shared);
void add_query(CLI::App& app, Shared& shared);
void add_bake(CLI::App& app, Shared& shared);
void add_check(CLI::App& app, Shared& shared);
void add_compare(CLI::App& app, Shared& shared);
void add_pathtrace(CLI::App& app, Shared& shared);
void add_quality(CLI::App& app, Shared& shared);
void add_basis(CLI::App& app, Shared& shared);
void add_bench(CLI::App& app, Shared& shared);
void add_report(CLI::App& app, Shared& shared);
void add_prepare(CLI::App& app, Shared& shared);  // hidden: a helper process of the others

}  // namespace clpv
