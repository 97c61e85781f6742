// SPDX-License-Identifier: MIT
#include "commands/manual.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <regex>
#include <vector>

namespace clpv {
namespace {

/// Text as roff takes it: its own characters escaped, a line's first one no request.
std::string roff(const std::string& text) {
  std::string out;
  bool line_begins = true;
  for (const char c : text) {
    if (line_begins && (c == '.' || c == '\'')) out += "\\&";
    if (c == '\\' || c == '-') out += '\\';
    out += c;
    line_begins = c == '\n';
  }
  return out;
}

bool is_shown(const CLI::Option& option) {
  return !option.get_group().empty();  // CLI11 hides what has no group
}

std::string roff_option(const CLI::Option& option) {
  const std::string type = option.get_type_name(), value = option.get_default_str();
  std::string text = ".TP\n\\fB" + roff(option.get_name(option.get_positional(), true)) + "\\fR";
  if (!type.empty()) text += " \\fI" + roff(type) + "\\fR";
  text += "\n" + roff(option.get_description());
  if (!value.empty()) text += roff(" [" + value + "]");
  return text + "\n";
}

std::string roff_options(const CLI::App& app) {
  std::string text;
  for (const CLI::Option* option : app.get_options()) {
    if (is_shown(*option)) text += roff_option(*option);
  }
  return text;
}

std::vector<std::string> long_names(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::Option* option : app.get_options()) {
    if (!is_shown(*option)) continue;
    for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
  }
  return names;
}

/// "a|b|c" in an option's help, or the values that CLI11 was told of ("{a,b,c}"), as words; empty where there are none.
std::string values_of(const CLI::Option& option) {
  static const std::regex choices("([a-z0-9][a-z0-9-]*(\\|[a-z0-9][a-z0-9-]*)+)"), set("\\{([a-z0-9,-]+)\\}");
  const std::string text = option.get_description(), type = option.get_type_name();
  std::smatch found;
  std::string words;
  if (std::regex_search(type, found, set) || std::regex_search(text, found, choices)) words = found[1];
  for (char& c : words) {
    if (c == '|' || c == ',') c = ' ';
  }
  return words;
}

/// Lines of a case on the word before: what may follow an option.
std::string value_cases(const CLI::App& app) {
  std::string text;
  for (const CLI::Option* option : app.get_options()) {
    const std::string words = values_of(*option);
    if (words.empty() || option->get_lnames().empty()) continue;
    text += fmt::format("        {}:--{}) words=\"{}\" ;;\n", app.get_name(), option->get_lnames().front(),
                        words);
  }
  return text;
}

}  // namespace

std::string man_page(const CLI::App& app, const std::string& version) {
  std::string text = fmt::format(
      ".\\\" Made by clpv from its options.\n"
      ".TH CLPV 1 \"\" \"clpv {}\"\n.SH NAME\nclpv \\- cascaded light propagation volumes in OpenCL\n"
      ".SH SYNOPSIS\n\\fBclpv\\fR [\\fIOPTIONS\\fR] \\fICOMMAND\\fR [\\fIOPTIONS\\fR]\n.SH OPTIONS\n",
      version);
  text += roff_options(app) + ".SH COMMANDS\n";
  for (const CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; })) {
    text += fmt::format(".SS {}\n{}\n", roff(command->get_name()), roff(command->get_description()));
    text += roff_options(*command);
    if (!command->get_footer().empty()) text += ".PP\n" + roff(command->get_footer()) + "\n";
  }
  return text + ".SH EXIT STATUS\n" + roff(app.get_footer()) + "\n";
}

std::string bash_completion(const CLI::App& app) {
  std::vector<std::string> commands;
  std::string options, values;
  for (const CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; })) {
    commands.push_back(command->get_name());
    options += fmt::format("        {}) words=\"{}\" ;;\n", command->get_name(),
                           fmt::join(long_names(*command), " "));
    values += value_cases(*command);
  }
  return fmt::format(
      "# Completion of clpv for bash; made by clpv from its options.\n"
      "_clpv() {{\n"
      "    local word=${{COMP_WORDS[COMP_CWORD]}} before=${{COMP_WORDS[COMP_CWORD-1]}} command= words= i\n"
      "    for ((i = 1; i < COMP_CWORD; i++)); do\n"
      "        case \" {0} \" in *\" ${{COMP_WORDS[i]}} \"*) command=${{COMP_WORDS[i]}}; break ;; esac\n"
      "    done\n"
      "    case $command:$before in\n{2}    esac\n"
      "    if [[ -z $words && $word == -* ]]; then\n"
      "        case $command in\n{1}        esac\n"
      "        words+=\" {3}\"\n"
      "    elif [[ -z $words && -z $command ]]; then\n"
      "        words=\"{0}\"\n"
      "    fi\n"
      "    if [[ -n $words ]]; then COMPREPLY=($(compgen -W \"$words\" -- \"$word\")); fi\n"
      "}}\n"
      "complete -o default -F _clpv clpv\n",
      fmt::join(commands, " "), options, values, fmt::join(long_names(app), " "));
}

}  // namespace clpv
