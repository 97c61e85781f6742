// SPDX-License-Identifier: MIT
// The sub-commands. Each adds itself to the program: its options, its help, and what it does when chosen.
#pragma once

#include <CLI/CLI.hpp>
#include <memory>
#include <span>
#include <string>

#include "parallel/ranks.hpp"

namespace clpv {

/// What every command shares.
struct Shared {
  std::string device;  ///< --device
  bool quiet = false;
  int verbosity = 0;
  /// The ranks that a launcher started this process with; the first call starts MPI.
  Ranks& ranks();
  std::unique_ptr<Ranks> started;  ///< none before
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
void parse_command_line(CLI::App& app, int argc, const char* const* argv);

/// The program but for its signals: parses, runs the command, says on stderr what failed. Returns the exit code. A rank that
/// fails ends all ranks.
int run_program(int argc, const char* const* argv);

// Each in commands/NAME.cpp. The callbacks throw clpv::Error; run_program turns it into an exit code.
void add_devices(CLI::App& app, Shared& shared);
void add_render(CLI::App& app, Shared& shared);
void add_sequence(CLI::App& app, Shared& shared);
void add_query(CLI::App& app, Shared& shared);
void add_propagate(CLI::App& app, Shared& shared);
void add_check(CLI::App& app, Shared& shared);
void add_compare(CLI::App& app, Shared& shared);
void add_pathtrace(CLI::App& app, Shared& shared);
void add_quality(CLI::App& app, Shared& shared);
void add_basis(CLI::App& app, Shared& shared);
void add_bench(CLI::App& app, Shared& shared);
void add_report(CLI::App& app, Shared& shared);

}  // namespace clpv
