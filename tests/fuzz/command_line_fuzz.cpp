// SPDX-License-Identifier: MIT
// A command line, an argument a line: parsed as the program parses it, commands not run; and each
// argument as a vector and as a box.
#include <algorithm>
#include <iterator>
#include <string>
#include <vector>

#include "cli/commands.hpp"
#include "cli/options.hpp"
#include "support/log.hpp"
#include "tests/fuzz/fuzz.hpp"

namespace {

std::vector<std::string> lines_of(std::string_view text) {
  std::vector<std::string> lines = {"clpv"};
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    // As the shell would hand it over: up to the first NUL.
    lines.emplace_back(text.substr(0, std::min(end, text.find('\0'))));
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return lines;
}

/// Those that can be chosen, since adding all takes some twenty times as long as parsing. All where
/// none is named, for the words about a misspelt one.
std::vector<clpv::Command> commands_named_in(const std::vector<std::string>& arguments) {
  const auto all = clpv::all_commands();
  std::vector<clpv::Command> named;
  std::ranges::copy_if(all, std::back_inserter(named), [&](const clpv::Command& command) {
    return std::ranges::any_of(arguments.begin() + 1, arguments.end(),
                               [&](const std::string& argument) {
                                 return argument.find(command.name) != std::string::npos;
                               });
  });
  return named.empty() ? std::vector(all.begin(), all.end()) : named;
}

void parse(std::vector<std::string> arguments) {
  CLI::App app;
  clpv::Shared shared;
  const std::vector<clpv::Command> commands = commands_named_in(arguments);
  clpv::add_commands(app, shared, commands);
  for (const clpv::Command& command : commands)
    app.get_subcommand(command.name);  // throws if it has another name
  // Before any command runs; their callbacks stay, since they hold what options are read into.
  app.parse_complete_callback([] { throw CLI::Success(); });
  std::vector<char*> pointers;
  for (std::string& argument : arguments) pointers.push_back(argument.data());
  try {
    clpv::parse_command_line(app, static_cast<int>(pointers.size()), pointers.data());
  } catch (const CLI::Error&) {  // usage, or a question for help
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace clpv;
  const std::vector<std::string> arguments = lines_of(fuzz::text_of(data, size));
  fuzz::read_or_reject({ExitCode::usage}, [&] { parse(arguments); });
  for (const std::string& argument : arguments)
    fuzz::read_or_reject({ExitCode::usage}, [&] { parse_vector(argument, "--option"); });
  return 0;
}
