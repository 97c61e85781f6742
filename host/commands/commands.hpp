// SPDX-License-Identifier: MIT
// The sub-commands. Each adds itself to the program: its options, its help, and what it does when chosen.
#pragma once

#include <CLI/CLI.hpp>
#include <memory>
#include <span>
#include <string>

namespace clpv {

class Team;

/// What every command shares.
struct Shared {
  std::string device;  ///< --device
  bool quiet = false;
  int verbosity = 0;
  /// The processes that a launcher started this one with; begun when it is first asked for.
  Team& team();
  std::shared_ptr<Team> begun;  ///< none yet, until it is
};

struct Command {
  const char* name;
  void (*add)(CLI::App& app, Shared& shared);
};

/// All of them, in the order of --help.
std::span<const Command> all_commands();

/// The program's description, the options of all commands, and the commands.
void add_commands(CLI::App& app, Shared& shared, std::span<const Command> commands = all_commands());

/// Parses, and runs the command. Throws CLI::Error, and Error(usage) that names the command meant by a misspelt one.
void parse_command_line(CLI::App& app, int argc, char** argv);

// Each in commands/NAME.cpp. The callbacks throw clpv::Error; main turns it into an exit code.
void add_devices(CLI::App& app, Shared& shared);
void add_render(CLI::App& app, Shared& shared);
void add_sequence(CLI::App& app, Shared& shared);
void add_query(CLI::App& app, Shared& shared);
void add_propagate(CLI::App& app, Shared& shared);
void add_check(CLI::App& app, Shared& shared);
void add_compare(CLI::App& app, Shared& shared);
void add_reference(CLI::App& app, Shared& shared);
void add_quality(CLI::App& app, Shared& shared);
void add_basis(CLI::App& app, Shared& shared);
void add_bench(CLI::App& app, Shared& shared);
void add_report(CLI::App& app, Shared& shared);

}  // namespace clpv
