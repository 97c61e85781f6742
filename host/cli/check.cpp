// SPDX-License-Identifier: MIT
// clpv check: compares every stage's kernels with double-precision CPU references on the chosen device.
#include "verify/check.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>

#include "cli/commands.hpp"
#include "cli/options.hpp"
#include "support/error.hpp"
#include "support/interrupt.hpp"
#include "support/log.hpp"
#include "support/named_enum.hpp"
#include "support/output_file.hpp"
#include "support/progress.hpp"
#include "verify/junit.hpp"

namespace clpv {

namespace reference {
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(CheckResult, stage, variant, worst, allowed, place)
}
namespace check_command {

struct Options {
  std::vector<Stage> only;
  std::string junit;
  bool json = false, thorough = false;
};

auto failures(const reference::CheckResults& results) {
  return std::count_if(results.begin(), results.end(), [](const auto& r) { return !r.passed(); });
}

/// Result with the largest error relative to its tolerance.
const reference::CheckResult& worst_of(const reference::CheckResults& results) {
  const auto share = [](const reference::CheckResult& r) {
    return r.passed() ? r.worst / std::max(r.allowed, 1e-300) : 1e300;
  };
  return *std::max_element(results.begin(), results.end(),
                           [&](const auto& a, const auto& b) { return share(a) < share(b); });
}

void print(std::string_view stage, const reference::CheckResults& results) {
  const auto failed = failures(results);
  const reference::CheckResult& worst = worst_of(results);
  fmt::print("{:<10} {:>4} of {:<4} {}  worst {:.2e} of {:.0e} allowed ({})\n", stage,
             results.size() - failed, results.size(), failed == 0 ? "ok    " : "FAILED", worst.worst,
             worst.allowed, worst.variant);
  for (const auto& r : results) {
    if (!r.passed())
      fmt::print("           {}: {:.3e} > {:.0e} at {}\n", r.variant, r.worst, r.allowed, r.place);
    if (r.passed()) spdlog::debug("{} {}: {:.2e} of {:.0e}", stage, r.variant, r.worst, r.allowed);
  }
  std::fflush(stdout);
}

nlohmann::json to_json(const reference::CheckResults& results) {
  nlohmann::json list = nlohmann::json::array();
  for (const auto& r : results) {
    list.push_back(nlohmann::json(r));
    list.back()["passed"] = r.passed();
  }
  return list;
}

void run(const Options& options, const Shared& shared) {
  if (!options.junit.empty()) check_writable(options.junit);
  Session session(choose_device(shared.device));
  spdlog::info("checking {} ({}), driver {}", session.device().name, session.device().platform,
               session.device().driver);
  reference::CheckResults all;
  Progress progress("check", values_of<Stage>().size());
  for (const Stage stage : values_of<Stage>()) {
    progress.advance();
    stop_if_interrupted(fmt::format("{} comparisons, {} failed", all.size(), failures(all)));
    if (!options.only.empty() && std::ranges::count(options.only, stage) == 0) continue;
    const reference::CheckResults results = reference::check(stage, session, {.thorough = options.thorough});
    if (results.empty()) throw Error(ExitCode::validation, "no comparison of stage {}", name_of(stage));
    if (!options.json) print(name_of(stage), results);
    all.insert(all.end(), results.begin(), results.end());
  }
  const auto failed = failures(all);
  if (options.json) {
    fmt::print("{}\n", nlohmann::json{{"schema", 1},
                                      {"device", to_json(session.device())},
                                      {"passed", failed == 0},
                                      {"checks", to_json(all)}}
                           .dump(2));
  }
  if (!options.junit.empty()) write_file(options.junit, reference::junit(all, session.device().name));
  if (failed > 0)
    throw Error(ExitCode::validation, "{} of {} comparisons failed on {}", failed, all.size(),
                session.device().name);
}

}  // namespace check_command

void add_check(CLI::App& app, Shared& shared) {
  using namespace check_command;
  CLI::App* command = app.add_subcommand(
      "check", "Compare every stage's kernels with double-precision CPU references on this device");
  auto options = std::make_shared<check_command::Options>();
  add_choices(*command, "--stage", options->only, "stages to check (default: all)");
  command->add_flag("--thorough", options->thorough,
                    "all combinations of bases, lobes, tables, transports and states; takes minutes");
  command->add_flag("--json", options->json, "JSON on stdout");
  add(*command, "--junit", "FILE.xml", options->junit,
      "output file in JUnit format, one test case per comparison");
  command->callback([options, &shared] { run(*options, shared); });
}

}  // namespace clpv
