// SPDX-License-Identifier: MIT
#include "bench/bench.hpp"

#include <cstdlib>

#include "support/error.hpp"
#include "support/log.hpp"
#include "support/progress.hpp"

namespace clpv::bench {
namespace {

std::vector<Case> filtered(std::vector<Case> cases, const std::optional<std::regex>& filter) {
  if (filter) std::erase_if(cases, [&](const Case& c) { return !std::regex_search(c.row.name, *filter); });
  return cases;
}

/// Ends the process, with what there is told.
[[noreturn]] void give_up(const BenchOptions& options, const std::string& suite, const std::string& name,
                          RowLog& log, Results results) {
  Row row;
  row.suite = suite;
  row.name = name;
  row.status = Status::timed_out;
  row.reason =
      fmt::format("not ready, or not run once, within {} s; the run ends with it", options.row_limit);
  results.rows.push_back(row);
  try {
    log.done(row);
    if (options.hung) options.hung(results);
  } catch (const std::exception& error) {
    spdlog::error("{}", error.what());
  }
  std::_Exit(static_cast<int>(ExitCode::run_time));  // the device still works, or the driver waits for it
}

}  // namespace

Results run_suite(Session& session, const Suite& suite, const BenchOptions& options) {
  const std::vector<Group> groups = suite.groups(session, options.suite);
  std::vector<std::vector<Case>> wanted;
  std::size_t count = 0;
  for (const Group& group : groups) {
    wanted.push_back(filtered(group.cases(), options.filter));
    count += wanted.back().size();
  }
  if (count == 0) throw Error(ExitCode::usage, "filter: no row of suite {} matches", suite.name);
  const bool ceilings_asked = suite.name == "ceilings";
  std::vector<Case> ceilings = ceiling_cases(session);
  if (!ceilings_asked) count += ceilings.size();
  Progress progress("bench " + suite.name, count * static_cast<std::size_t>(options.repetitions + 1));

  Results results;
  RowLog log(options.log);
  RowWatch watch(std::chrono::duration<double>(options.row_limit),
                 [&](const std::string& name) { give_up(options, suite.name, name, log, results); });
  RunnerOptions runner{options.repetitions, nullptr, &progress, &watch, &log};
  if (ceilings_asked) {
    results.rows = run_cases(session, wanted.front(), runner);
    results.ceilings = ceilings_of(results.rows);
    return results;
  }
  results.ceilings = ceilings_of(run_cases(session, ceilings, runner));
  runner.ceilings = &results.ceilings;
  for (std::vector<Case>& cases : wanted) {
    if (cases.empty()) continue;
    for (Row& row : run_cases(session, cases, runner)) results.rows.push_back(std::move(row));
    cases.clear();
  }
  return results;
}

}  // namespace clpv::bench
