// SPDX-License-Identifier: MIT
#include "clpv/options.hpp"

#include "options/render_options.hpp"

namespace clpv {

Options& Options::set(std::string_view name, std::string_view value) {
  RenderOptions probe;
  set_option(probe, name, value);
  given_[std::string(name)] = value;
  return *this;
}

std::vector<OptionDescription> Options::all() {
  std::vector<OptionDescription> all;
  for (const OptionInfo& info : list_options(RenderOptions{}))
    all.push_back({info.name, info.help, info.allowed, info.value});
  return all;
}

}  // namespace clpv
