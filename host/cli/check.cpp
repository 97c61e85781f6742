// SPDX-License-Identifier: MIT
// clpv check: compares every stage's kernels with double-precision CPU references on the chosen device.
#include "verify/check.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>

#include "cli/commands.hpp"
#include "cli/options.hpp"
#include "parallel/ranks.hpp"
#include "support/error.hpp"
#include "support/helpers.hpp"
#include "support/interrupt.hpp"
#include "support/log.hpp"
#include "support/named_enum.hpp"
#include "support/output_file.hpp"
#include "support/progress.hpp"
#include "verify/junit.hpp"

namespace clpv {

namespace reference {

/// A NaN has no number in JSON: null.
void from_json(const nlohmann::json& json, CheckResult& result) {
  result.stage = json.at("stage");
  result.variant = json.at("variant");
  result.worst = json.at("worst").is_null() ? std::nan("") : json.at("worst").get<double>();
  result.allowed = json.at("allowed");
  result.place = json.at("place");
  result.seconds = json.at("seconds");
}

void to_json(nlohmann::json& json, const CheckResult& result) {
  json = {{"stage", result.stage},     {"variant", result.variant}, {"worst", result.worst},
          {"allowed", result.allowed}, {"place", result.place},     {"seconds", result.seconds}};
}

}  // namespace reference
namespace check_command {

struct Options {
  std::vector<Stage> only;
  std::vector<std::string> match;
  std::string junit, claims, format;
  bool thorough = false, list = false;
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

/// One comparison: its stage, and its number within the stage.
struct Job {
  Stage stage;
  int number;
  std::string variant;
  std::string name() const { return fmt::format("{}-{}", name_of(stage), number); }
};

reference::CheckScope scope_of(const Options& options) {
  return options.thorough ? reference::thorough_scope() : reference::CheckScope{};
}

bool matches(const Options& options, const std::string& variant) {
  return std::ranges::all_of(
      options.match, [&](const std::string& text) { return variant.find(text) != std::string::npos; });
}

/// Runs the comparisons of a stage that the options name and for which take(job) returns true. Calls finished(job,
/// results) after each.
template <typename Take, typename Finished>
void check_stage(Session& session, const Options& options, Stage stage, const Take& take,
                 const Finished& finished) {
  Job job{stage, 0, {}};
  reference::CheckScope scope = scope_of(options);
  scope.selects = [&](std::string_view, const std::string& variant) {
    if (!matches(options, variant)) return false;
    ++job.number;
    job.variant = variant;
    return take(job);
  };
  scope.finished = [&](const reference::CheckResults& results) { finished(job, results); };
  reference::check(stage, session, scope);
}

std::vector<Stage> stages_of(const Options& options) {
  std::vector<Stage> stages;
  for (const Stage stage : values_of<Stage>()) {
    if (options.only.empty() || std::ranges::count(options.only, stage) > 0) stages.push_back(stage);
  }
  return stages;
}

/// Lists all comparisons that the options name, in order. Throws Error(usage) if there is none.
std::vector<Job> list_jobs(Session& session, const Options& options) {
  std::vector<Job> jobs;
  const auto keep = [&](const Job& job) {
    jobs.push_back(job);
    return false;
  };
  for (const Stage stage : stages_of(options)) check_stage(session, options, stage, keep, [](auto&&...) {});
  if (jobs.empty())
    throw Error(ExitCode::usage, "--match {}: no comparison has it; clpv check --list shows their names",
                fmt::join(options.match, " "));
  return jobs;
}

/// Takes whole stages, since their comparisons share kernels, and then single comparisons of stages that others took,
/// until none is left. The last stages take longest and come first, but for the sweep, whose kernels `bounce` uses too.
void help(Session& session, const Options& options) {
  become_helper();
  const Claims claims(options.claims);
  std::vector<Stage> stages = stages_of(options);
  std::ranges::reverse(stages);
  std::stable_partition(stages.begin(), stages.end(), [](Stage stage) { return stage == Stage::sweep; });
  const auto take_from = [&](Stage stage) {
    check_stage(
        session, options, stage, [&](const Job& job) { return claims.take(job.name()); },
        [&](const Job& job, const reference::CheckResults& results) {
          claims.finish(job.name(), nlohmann::json(results).dump());
        });
  };
  for (const Stage stage : stages) {
    if (claims.take(std::string(name_of(stage)))) take_from(stage);
  }
  for (const Stage stage : stages) take_from(stage);
}

/// Collects results of the comparisons and prints each stage when it is complete.
class Results {
 public:
  Results(const std::vector<Job>& jobs, bool prints)
      : jobs_(jobs), prints_(prints), progress_("check", jobs.size()) {}

  void add(const reference::CheckResults& results) {
    all_.insert(all_.end(), results.begin(), results.end());
    stage_.insert(stage_.end(), results.begin(), results.end());
    const Stage stage = jobs_[done_].stage;
    ++done_;
    progress_.reach(done_);
    if (done_ < jobs_.size() && jobs_[done_].stage == stage) return;
    if (prints_) print(name_of(stage), stage_);
    stage_.clear();
  }

  const Job* next() const { return done_ < jobs_.size() ? &jobs_[done_] : nullptr; }
  const reference::CheckResults& all() const { return all_; }
  void reach(std::size_t done) { progress_.reach(done); }
  void stop_if_interrupted() const {
    clpv::stop_if_interrupted(fmt::format("{} comparisons, {} failed", all_.size(), failures(all_)));
  }

 private:
  const std::vector<Job>& jobs_;
  bool prints_;
  Progress progress_;
  std::size_t done_ = 0;
  reference::CheckResults all_, stage_;
};

/// Arguments of a helper that runs comparisons of the same options.
std::vector<std::string> helper_arguments(const Options& options, const Shared& shared) {
  std::vector<std::string> arguments = {"check"};
  for (const Stage stage : options.only) arguments.push_back(fmt::format("--stage={}", name_of(stage)));
  for (const std::string& text : options.match) arguments.push_back("--match=" + text);
  if (options.thorough) arguments.push_back("--thorough");
  if (!shared.device.empty()) arguments.push_back("--device=" + shared.device);
  arguments.push_back("--quiet");
  return arguments;
}

void check_with_helpers(const Options& options, const Shared& shared, Results& results) {
  Helpers helpers(helper_arguments(options, shared));
  for (bool running = true; running;) {
    running = helpers.wait();
    results.stop_if_interrupted();
    results.reach(helpers.claims().finished_count());
    for (const Job* job; (job = results.next()) != nullptr && helpers.claims().finished(job->name());)
      results.add(nlohmann::json::parse(helpers.claims().result(job->name())).get<reference::CheckResults>());
  }
  if (const Job* job = results.next())
    throw Error(ExitCode::run_time, "comparison '{}' of stage {} did not end:\n{}", job->variant,
                name_of(job->stage), helpers.failures());
}

void check_here(Session& session, const Options& options, Results& results) {
  for (const Stage stage : stages_of(options)) {
    check_stage(
        session, options, stage,
        [&](const Job&) {
          results.stop_if_interrupted();
          return true;
        },
        [&](const Job&, const reference::CheckResults& found) { results.add(found); });
  }
}

void run(const Options& options, const Shared& shared) {
  if (!options.junit.empty()) check_writable(options.junit);
  Session session(choose_device(shared.device));
  if (!options.claims.empty()) return help(session, options);
  const std::vector<Job> jobs = list_jobs(session, options);
  if (options.list) {
    for (const Job& job : jobs) fmt::print("{:<10} {}\n", name_of(job.stage), job.variant);
    return;
  }
  spdlog::info("checking {} ({}), driver {}: {} comparisons", session.device().name,
               session.device().platform, session.device().driver, jobs.size());
  const bool json = options.format == "json";
  Results results(jobs, !json);
  const bool alone = helper_count() == 0 || jobs.size() < 2 || launcher_rank();
  if (alone)
    check_here(session, options, results);
  else
    check_with_helpers(options, shared, results);
  const reference::CheckResults& all = results.all();
  const auto failed = failures(all);
  if (json) {
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
  command->add_flag(
      "--thorough", options->thorough,
      "all combinations of bases, formats, lobes, tables, transports, states and directions; takes minutes. "
      "Without it, each path of a kernel once: one basis of each kind, each layout and number format");
  command
      ->add_option("--match", options->match,
                   "only comparisons with this text in their name, such as a basis or layout; repeatable")
      ->type_name("TEXT");
  command->add_flag("--list", options->list, "print the names of the comparisons and end");
  add(*command, "--claims", "DIR", options->claims, "folder shared with other helpers")->group("");
  add_format(*command, options->format);
  add(*command, "--junit", "FILE.xml", options->junit,
      "output file in JUnit format, one test case per comparison");
  command->callback([options, &shared] { run(*options, shared); });
}

}  // namespace clpv
