// SPDX-License-Identifier: MIT
#include "cli/commands.hpp"

#include <fmt/ranges.h>

#include <CL/opencl.hpp>
#include <algorithm>
#include <csignal>
#include <optional>
#include <sstream>

#include "cli/options.hpp"
#include "clpv/version.hpp"
#include "device/cl_error.hpp"
#include "device/program.hpp"
#include "support/error.hpp"
#include "support/helpers.hpp"
#include "support/input_file.hpp"
#include "support/interrupt.hpp"
#include "support/log.hpp"
#include "support/process.hpp"
#include "support/progress.hpp"
#include "support/text.hpp"

namespace clpv {
namespace {

/// Rank 0 logs at the requested level; other ranks log only problems unless --verbose is given.
void set_log(const Shared& shared) {
  const std::optional<LauncherRank> started = launcher_rank();
  log_to_stderr(shared.quiet                   ? LogLevel::error
                : shared.verbose               ? LogLevel::debug
                : started && started->rank > 0 ? LogLevel::warning
                                               : LogLevel::info);
  if (!started) return;
  set_progress_style(started->rank == 0 ? ProgressStyle::lines : ProgressStyle::none);
}

/// Commands that distribute work over ranks; each rank would repeat all work of any other command.
void reject_ranks_except(CLI::App& app, const std::vector<std::string>& names) {
  for (CLI::App* command : app.get_subcommands({})) {
    const std::string name = command->get_name();
    if (std::ranges::count(names, name) > 0) continue;
    command->parse_complete_callback([name, names] {
      const std::optional<LauncherRank> started = launcher_rank();
      if (!started) return;
      throw Error(ExitCode::usage,
                  "{}: not for several processes (found: rank {} of {}); allowed: {}", name,
                  started->rank, started->size ? std::to_string(*started->size) : "some",
                  fmt::join(names, ", "));
    });
  }
}

/// Throws Error(usage) for an unknown command.
void reject_unknown_command(const CLI::App& app) {
  const std::vector<std::string> words = app.remaining();
  const auto word =
      std::ranges::find_if(words, [](const std::string& w) { return !w.starts_with('-'); });
  if (word == words.end()) return;
  std::vector<std::string> names;
  for (const CLI::App* command : app.get_subcommands({}))
    if (!command->get_group().empty()) names.push_back(command->get_name());
  throw Error(ExitCode::usage, "unknown command '{}'; allowed: {}; the viewer is {}", *word,
              fmt::join(names, ", "), "python3 -m clpv.view");
}

/// Throws Error(usage) for an unknown option of the command.
void reject_unknown_option(const CLI::App& app) {
  const std::vector<CLI::App*> named = app.get_subcommands();
  for (const std::string& word : app.remaining(true)) {
    if (word.starts_with('-'))
      throw Error(ExitCode::usage, "{}unknown option '{}'; --help-all lists those allowed",
                  named.empty() ? "" : named.front()->get_name() + ": ",
                  word.substr(0, word.find('=')));
  }
}

/// Leaves the options of some groups to --help-all, before `app` prints its help and ends.
void shorten_help(CLI::App& app) {
  const std::vector<CLI::Option*> rare = app.get_options(
      [](CLI::Option* option) { return option->get_group().starts_with(kMoreOptions); });
  for (CLI::Option* option : rare) app.remove_option(option);
  const std::string footer = app.get_footer();
  if (!rare.empty())
    app.footer(fmt::format("--help-all lists {} more option{}, by stage.{}{}", rare.size(),
                           rare.size() == 1 ? "" : "s", footer.empty() ? "" : "\n", footer));
  for (CLI::App* command : app.get_subcommands()) shorten_help(*command);
}

/// Returns a message prefix like "rank 3 on node7: " if there are several ranks.
std::string rank_prefix(const Shared& shared) {
  return shared.started && !shared.started->alone() ? shared.started->name() + ": " : "";
}

/// Logs the error and aborts the other ranks.
int report_failure(const Shared& shared, ExitCode code, const std::string& message) {
  print_message(fmt::format("clpv: {}{}\n", rank_prefix(shared), message));
  if (shared.started && !shared.started->alone()) shared.started->abort(code);
  return static_cast<int>(code);
}

}  // namespace

Ranks& Shared::ranks() {
  if (!started)
    started = launcher_rank() ? std::make_unique<Ranks>(start_mpi()) : std::make_unique<Ranks>();
  return *started;
}

std::span<const Command> all_commands() {
  static constexpr Command kCommands[] = {
      {"devices", "Verify", add_devices},   {"render", "Look", add_render},
      {"sequence", "Look", add_sequence},   {"query", "Look", add_query},
      {"bake", "Look", add_bake},           {"check", "Verify", add_check},
      {"compare", "Look", add_compare},     {"quality", "Measure", add_quality},
      {"pathtrace", "Look", add_pathtrace}, {"basis", "Measure", add_basis},
      {"bench", "Measure", add_bench},      {"report", "Measure", add_report},
  };
  return kCommands;
}

void add_commands(CLI::App& app, Shared& shared, std::span<const Command> commands) {
  app.description("clpv: cascaded light propagation volumes in OpenCL");
  app.name("clpv");
  app.set_version_flag("--version", "clpv " + version(), "version of the program");
  app.set_help_flag("-h,--help", "this help");
  app.set_help_all_flag("--help-all", "also show rarer options");
  add(app, "-d,--device", "DEVICE", shared.device,
      "OpenCL device: index, PLATFORM:DEVICE or part of a name (default: CLPV_DEVICE, else the "
      "first supported)");
  app.add_option_function<std::string>(
         "--lanes",
         [](const std::string& lanes) {
           ::setenv("CLPV_LANES", lanes.c_str(), 1);
         },  // helpers inherit it
         "pixels, cells or rays that a work-item processes (default: CLPV_LANES, else auto: 8 on "
         "CPUs, 1 elsewhere)")
      ->type_name("auto|1|8")
      ->check(CLI::IsMember({"auto", "1", "8"}))
      ->group(std::string(kMoreOptions) + "device");
  app.add_flag("-q,--quiet", shared.quiet, "no messages but errors");
  app.add_flag("-v,--verbose", shared.verbose, "more log messages")->disable_flag_override();
  app.require_subcommand(1);
  app.fallthrough();
  app.parse_complete_callback([&] { set_log(shared); });
  for (const Command& command : commands) {
    command.add(app, shared);
    CLI::App* added = app.get_subcommand(command.name);
    added->group(command.group);
    group_options(*added);
  }
  add_prepare(app, shared);
  reject_ranks_except(app, {"quality", "sequence", "pathtrace"});
  app.footer(
      "Exit codes: 0 ok; 1 run-time failure (device memory, unwritable output); 2 usage; 3 bad "
      "scene or image file;\n"
      "4 no device, or one that lacks what was asked; 5 validation failed. Data goes to stdout, "
      "logs to stderr.");
}

void parse_command_line(CLI::App& app, int argc, const char* const* argv) {
  try {
    if (argc > 1 && std::string_view(argv[1]) == "help") {  // `help render` is `render --help`
      std::vector<const char*> words(argv, argv + argc);
      words.erase(words.begin() + 1);
      words.push_back("--help");
      app.parse(static_cast<int>(words.size()), words.data());
      return;
    }
    app.parse(argc, argv);
  } catch (const CLI::ExtrasError&) {
    reject_unknown_option(app);
    throw;
  } catch (const CLI::RequiredError&) {
    if (app.get_subcommands().empty()) reject_unknown_command(app);
    reject_unknown_option(app);
    throw;
  } catch (const CLI::ArgumentMismatch& error) {
    const std::string what = error.what(), option = what.substr(0, what.find(':'));
    if (what.find(" required ") == std::string::npos) throw;
    throw Error(ExitCode::usage, "{}: found {}, allowed: one", option,
                what.ends_with("missing") ? "no value" : "several values");
  } catch (const CLI::ValidationError& error) {  // by CLI::IsMember: "--view: a not in {b,c}"
    const std::string what = error.what();
    const std::size_t colon = what.find(": "), found = what.rfind(" not in {");
    if (found == std::string::npos) throw;
    throw Error(ExitCode::usage, "{}: found '{}', allowed: {}", what.substr(0, colon),
                what.substr(colon + 2, found - colon - 2),
                what.substr(found + 9, what.size() - found - 10));
  }
}

namespace {

/// Prints help, or a usage error. Returns the exit code.
int answer(CLI::App& app, const CLI::ParseError& error) {
  std::ostringstream out, err;
  if (error.get_name() == "CallForHelp") shorten_help(app);
  app.exit(error, out, err);
  print_text(out.str());
  if (!err.str().empty()) print_message("clpv: " + err.str());
  return error.get_exit_code() == 0 ? 0 : static_cast<int>(ExitCode::usage);
}

/// Parses the command line and runs the command, or prints the help. Returns the exit code.
int parse_and_run(CLI::App& app, int argc, const char* const* argv) {
  if (argc == 1) {
    shorten_help(app);
    print_text(app.help());
    return 0;
  }
  try {
    parse_command_line(app, argc, argv);
    return 0;
  } catch (const CLI::ParseError& error) {
    return answer(app, error);
  }
}

}  // namespace

int run_program(int argc, const char* const* argv, const Additions& additions) {
  const InputRecord record;
  record_kernel_files();
  CLI::App app;
  Shared shared;
  shared.additions = additions;
  add_commands(app, shared);
  log_to_stderr(LogLevel::warning);  // until options set another level
  try {
    const int code = parse_and_run(app, argc, argv);
    flush_data();
    return code;
  } catch (const Interrupted& interrupted) {
    print_message(
        fmt::format("clpv: {}interrupted; {}\n", rank_prefix(shared), interrupted.what()));
    end_as_interrupted();
  } catch (const Error& error) {
    return report_failure(shared, error.code(), error.what());
  } catch (const cl::Error& error) {
    const Error named = cl_error(error);
    return report_failure(shared, named.code(), named.what());
  } catch (const std::bad_alloc&) {
    return report_failure(shared, ExitCode::run_time, "out of memory");
  } catch (const std::exception& error) {
    return report_failure(shared, ExitCode::run_time, error.what());
  }
}

int program_main(int argc, char** argv) {
  return program_main(argc, argv, Additions{});
}

int program_main(int argc, char** argv, const Additions& additions) {
  reset_inherited_state();
  keep_absolute_path_entries();
  catch_interrupts();
  std::signal(SIGXFSZ, SIG_IGN);  // a write beyond `ulimit -f` then fails with a reason
  set_helper_program("/proc/self/exe");
  return run_program(argc, argv, additions);
}

}  // namespace clpv
