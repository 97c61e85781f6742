// SPDX-License-Identifier: MIT
// The sub-commands. Each adds its options, help and callback to the program.
#pragma once

#include <CLI/CLI.hpp>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "cli/quality_subjects.hpp"
#include "device/session.hpp"
#include "parallel/ranks.hpp"
#include "quality/quality.hpp"
#include "support/output_file.hpp"

namespace clpv {

// Additions of another program to the commands: the lab (lab/README.md) adds methods to `quality`.

struct Shared;
/// Adds a command to the program.
using AddCommand = void(CLI::App& app, Shared& shared);

/// Cells that stand beside the variants of `clpv quality`. The calls come in this order, once each.
struct QualityAddition {
  virtual ~QualityAddition() = default;
  virtual void add_options(CLI::App& command) = 0;
  /// The option that asks for cells ("--baseline") if the command line has it, else empty.
  virtual std::string asked() const = 0;
  /// Creates the folders of the files that measure() writes, and returns their names. Throws
  /// Error(usage) if two subjects share one.
  virtual std::vector<NamedFile> outputs(const std::vector<Subject>& subjects) const = 0;
  /// Measures the cells of all views of the subjects, which have their ground truths. `frame_of`:
  /// options of the frame that the command line names.
  virtual std::vector<QualityCell> measure(
      Session& session, const std::vector<Subject>& subjects,
      const std::function<RenderOptions(const SceneData&)>& frame_of, int bounces, Show show,
      int frames) const = 0;
};

struct Additions {
  std::shared_ptr<QualityAddition> quality;  ///< null: none
};

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
  AddCommand* add;
};

/// All commands, in the order of --help.
std::span<const Command> all_commands();

/// Adds the program's description, the shared options and the commands.
void add_commands(CLI::App& app, Shared& shared,
                  std::span<const Command> commands = all_commands());

/// Parses and runs the command. Throws CLI::Error, and Error(usage) for unknown ones.
void parse_command_line(CLI::App& app, int argc, const char* const* argv);

/// The program without signal handling: parses, runs the command and logs errors to stderr. Returns
/// the exit code. A failing rank aborts all ranks.
int run_program(int argc, const char* const* argv, const Additions& additions = {});

// Each command is in cli/NAME.cpp. The callbacks throw clpv::Error; run_program turns it into an
// exit code.
AddCommand add_devices, add_render, add_sequence, add_query, add_bake, add_check, add_compare,
    add_pathtrace, add_quality, add_basis, add_bench, add_report;
AddCommand add_prepare;  // hidden: a helper process of the others

/// Prints the changes of a report against an earlier one, for `clpv compare`. Throws
/// Error(bad_input) if one is no report or if their kinds differ, Error(validation) if no row has a
/// value in both, or, with a `limit` above 0, if a value has become larger than `limit` times the
/// earlier one, beyond the spread, or is lost.
void compare_reports(const std::string& after_file, const std::string& before_file, double limit);

// main() of clpv, without the parser's headers, which take five seconds to compile.

struct Additions;

/// Sets up signals and helper processes, then run_program() (cli/commands.hpp).
int program_main(int argc, char** argv);
int program_main(int argc, char** argv, const Additions& additions);

}  // namespace clpv
