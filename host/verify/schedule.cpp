// SPDX-License-Identifier: MIT
#include "verify/schedule.hpp"

#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <map>
#include <nlohmann/json.hpp>
#include <set>

#include "support/error.hpp"
#include "support/interrupt.hpp"

namespace clpv::verify {
namespace {

constexpr int kSignalled = 128;  // exit code after a signal, less the signal (Process::Result)

std::string claim_of(std::size_t number) {
  return fmt::format("case-{}", number);
}

CheckResult from_json(const nlohmann::json& json) {
  const auto number = [&](const char* key) {
    return json.at(key).is_null() ? std::nan("") : json.at(key).get<double>();
  };
  return {json.at("stage"),
          json.at("variant"),
          {number("worst"), number("allowed"), json.at("place")},
          named<Status>("status", json.at("status").get<std::string>()),
          json.at("reason"),
          json.at("seconds")};
}

std::string words_of(const Helpers::Ended& ended) {
  std::string words =
      ended.code > kSignalled
          ? fmt::format("the process ended by signal {} ({})", ended.code - kSignalled,
                        ::strsignal(ended.code - kSignalled))
          : fmt::format("the process ended with {}", ended.code);
  if (!ended.output.empty()) words += ": " + ended.output;
  while (words.ends_with('\n')) words.pop_back();
  return words;
}

/// Cases in helper processes.
class Dispatch {
 public:
  Dispatch(const Cases& cases, const std::vector<std::string>& arguments, double limit)
      : cases_(cases), limit_(limit), helpers_(arguments, std::max(1u, helper_count())) {}

  void run(const Finished& finished, const Reached& reached) {
    for (std::size_t next = 0; next < cases_.size();) {
      bool running = helpers_.wait();
      const std::size_t count = helpers_.claims().finished_count();
      stop_if_interrupted(fmt::format("{} of {} comparisons were finished", count, cases_.size()));
      reached(count);
      end_overdue();
      running = replace_ended() || running;
      if (!running) fail_rest();
      for (; next < cases_.size() && is_done(next); ++next) finished(results_of(next));
    }
  }

 private:
  bool is_done(std::size_t number) const {
    return failures_.contains(number) || helpers_.claims().finished(claim_of(number));
  }

  CheckResults results_of(std::size_t number) const {
    if (const auto failure = failures_.find(number); failure != failures_.end())
      return {result_of(name_of(cases_[number].stage), cases_[number].name, Status::failed,
                        failure->second)};
    CheckResults results;
    for (const nlohmann::json& result :
         nlohmann::json::parse(helpers_.claims().result(claim_of(number))))
      results.push_back(from_json(result));
    return results;
  }

  /// Calls action(number, taken) for each case that a helper has taken and not finished.
  template <typename Action>
  void for_unfinished(const Action& action) {
    for (std::size_t number = 0; number < cases_.size(); ++number) {
      if (is_done(number)) continue;
      if (const auto taken = helpers_.claims().taken(claim_of(number))) action(number, *taken);
    }
  }

  void end_overdue() {
    for_unfinished([&](std::size_t number, const Claims::Taken& taken) {
      if (taken.age.count() <= limit_) return;
      helpers_.kill(taken.process);
      killed_.insert(taken.process);
      failures_[number] = fmt::format("took more than --limit {} s", limit_);
    });
  }

  /// Fails the cases that ended helpers did not finish, and starts another helper in the place of
  /// each such helper. Returns true if one was started.
  bool replace_ended() {
    bool started = false;
    for (; replaced_ < helpers_.ended().size(); ++replaced_) {
      const Helpers::Ended ended = helpers_.ended()[replaced_];
      bool lost = killed_.contains(ended.process);
      for_unfinished([&](std::size_t number, const Claims::Taken& taken) {
        if (taken.process != ended.process) return;
        failures_[number] = words_of(ended);
        lost = true;
      });
      if (lost) helpers_.start();
      started = started || lost;
    }
    return started;
  }

  /// Fails all cases that are left when no helper can run them.
  void fail_rest() {
    for (std::size_t number = 0; number < cases_.size(); ++number)
      if (!is_done(number)) failures_[number] = words_of(helpers_.ended().back());
  }

  const Cases& cases_;
  double limit_;
  Helpers helpers_;
  std::map<std::size_t, std::string> failures_;  ///< reasons, by number of the case
  std::set<pid_t> killed_;                       ///< overdue helpers
  std::size_t replaced_ = 0;                     ///< ended helpers that are dealt with
};

}  // namespace

Cases CheckChoice::cases() const {
  Cases all;
  if (preset) {
    RenderOptions options;
    apply_preset(options, *preset);
    all = cases_of(options);
  } else {
    for (const Stage stage : values_of<Stage>())
      std::ranges::move(cases_of(stage, thorough ? thorough_scope() : CheckScope{}),
                        std::back_inserter(all));
  }
  std::erase_if(all, [&](const Case& c) {
    const auto has = [&](const std::string& text) {
      return c.name.find(text) != std::string::npos;
    };
    return (!stages.empty() && std::ranges::count(stages, c.stage) == 0) ||
           !std::ranges::all_of(match, has);
  });
  if (all.empty())
    throw Error(ExitCode::usage,
                "--match {}: no comparison has it; clpv check --list shows their names",
                fmt::join(match, " "));
  if (only.empty()) return all;
  Cases chosen;
  for (const std::size_t number : only) {
    if (number >= all.size())
      throw Error(ExitCode::usage, "--only {}: allowed: less than {}", number, all.size());
    chosen.push_back(all[number]);
  }
  return chosen;
}

std::vector<std::string> CheckChoice::arguments() const {
  std::vector<std::string> arguments = {"check"};
  for (const Stage stage : stages) arguments.push_back(fmt::format("--stage={}", name_of(stage)));
  for (const std::string& text : match) {
    if (!text.empty())
      arguments.push_back("--match=" + text);  // empty, it would take the next word
  }
  if (thorough) arguments.push_back("--thorough");
  if (preset) arguments.push_back(fmt::format("--preset={}", name_of(*preset)));
  for (const std::size_t number : only) arguments.push_back(fmt::format("--only={}", number));
  return arguments;
}

void run_here(const Cases& cases, Session& session, const Finished& finished) {
  std::size_t done = 0;
  for (const Case& compared : cases) {
    stop_if_interrupted(fmt::format("{} of {} comparisons were finished", done++, cases.size()));
    finished(run_case(compared, session));
  }
}

void run_in_helpers(const Cases& cases, const std::vector<std::string>& arguments, double limit,
                    const Finished& finished, const Reached& reached) {
  Dispatch(cases, arguments, limit).run(finished, reached);
}

void help(const Cases& cases, const std::function<CheckResults(const Case&)>& run,
          const Claims& claims) {
  const auto run_stage = [&](Stage stage) {
    for (std::size_t number = 0; number < cases.size(); ++number) {
      if (cases[number].stage != stage || !claims.take(claim_of(number))) continue;
      nlohmann::json results = nlohmann::json::array();
      for (const CheckResult& result : run(cases[number])) results.push_back(to_json(result));
      claims.finish(claim_of(number), results.dump());
    }
  };
  // The last stages take longest and come first, but for the sweep, whose kernels `bounce` uses
  // too.
  std::vector<Stage> order = {Stage::sweep};
  for (const Stage stage : values_of<Stage>())
    if (stage != Stage::sweep) order.insert(order.begin() + 1, stage);
  for (const Stage stage : order)
    if (claims.take(std::string(name_of(stage)))) run_stage(stage);
  for (const Stage stage : order) run_stage(stage);
}

nlohmann::json to_json(const CheckResult& result) {
  return {{"stage", result.stage},
          {"variant", result.variant},
          {"status", name_of(result.status)},
          {"passed", result.passed()},
          {"worst", result.deviation.worst},
          {"allowed", result.deviation.allowed},
          {"place", result.deviation.place},
          {"reason", result.reason},
          {"seconds", result.seconds}};
}

}  // namespace clpv::verify
