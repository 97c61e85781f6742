// SPDX-License-Identifier: MIT
// Values of an enumeration on the command line, by their names.
#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "support/named_enum.hpp"

namespace clpv {

/// One value; what `member` holds is the default. `member` must outlive the parse, as below.
template <NamedEnum E>
CLI::Option* add_choice(CLI::App& command, const std::string& option, E& member, const std::string& help) {
  const auto take = [&member, option](const std::string& name) { member = named<E>(option, name); };
  return command.add_option_function<std::string>(option, take, help)
      ->check(CLI::IsMember(names_of<E>()))
      ->default_str(std::string(name_of(member)));
}

/// Several, between commas.
template <NamedEnum E>
CLI::Option* add_choices(CLI::App& command, const std::string& option, std::vector<E>& members,
                         const std::string& help) {
  const auto take = [&members, option](const std::vector<std::string>& all) {
    members.clear();
    for (const std::string& name : all) members.push_back(named<E>(option, name));
  };
  return command.add_option_function<std::vector<std::string>>(option, take, help)
      ->delimiter(',')
      ->check(CLI::IsMember(names_of<E>()));
}

}  // namespace clpv
