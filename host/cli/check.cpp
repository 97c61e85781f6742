// SPDX-License-Identifier: MIT
// clpv check: compares every stage's kernels with double-precision CPU references on the chosen
// device.
#include "verify/check.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <nlohmann/json.hpp>

#include "cli/commands.hpp"
#include "cli/options.hpp"
#include "support/error.hpp"
#include "support/helpers.hpp"
#include "support/log.hpp"
#include "support/output_file.hpp"
#include "support/progress.hpp"
#include "verify/capsules.hpp"
#include "verify/schedule.hpp"

namespace clpv {
namespace check_command {

using verify::CheckResult, verify::CheckResults, verify::Status;

constexpr double kUsualLimit = 600;  // [s]; the longest takes 20 s where all kernels are compiled

struct Options {
  verify::CheckChoice choice;
  std::string junit, claims, format, capsules, record;
  std::vector<std::string> capsule;  ///< names of comparisons
  double limit = kUsualLimit;
  bool list = false;
};

std::size_t count(const CheckResults& results, Status status) {
  return static_cast<std::size_t>(std::ranges::count(results, status, &CheckResult::status));
}

/// "propagate sh2/sampled/areas"
std::string title_of(const verify::Case& c) {
  return fmt::format("{} {}", name_of(c.stage), c.name);
}

/// "118 ok, 1 wrong, 0 failed, 4 unsupported"
std::string counts_of(const CheckResults& results) {
  std::string text;
  for (const Status status : values_of<Status>())
    text +=
        fmt::format("{}{} {}", text.empty() ? "" : ", ", count(results, status), name_of(status));
  return text;
}

/// Prints a stage: how many results are ok, the largest error relative to its tolerance, and each
/// other result.
void print(std::string_view stage, const CheckResults& results) {
  const std::size_t ok = count(results, Status::ok),
                    unsupported = count(results, Status::unsupported);
  print_data("{:<10} {:>4} of {:<4} {}", stage, ok, results.size(),
             ok + unsupported < results.size() ? "FAILED"
             : ok > 0                          ? "ok    "
                                               : "none  ");
  const auto share = [](const CheckResult& r) {
    return r.passed() ? r.deviation.worst / std::max(r.deviation.allowed, 1e-300) : -1;
  };
  if (ok > 0) {
    const CheckResult& worst = *std::ranges::max_element(results, {}, share);
    print_data("  worst {:.2e} of {:.0e} allowed ({})", worst.deviation.worst,
               worst.deviation.allowed, worst.variant);
  }
  print_data("\n");
  for (const CheckResult& r : results) {
    if (r.passed())
      log_debug("{} {}: {:.2e} of {:.0e}", stage, r.variant, r.deviation.worst,
                r.deviation.allowed);
    else if (r.status == Status::wrong)
      print_data("           {}: {:.3e} > {:.0e} at {}\n", r.variant, r.deviation.worst,
                 r.deviation.allowed, r.deviation.place);
    else
      print_data("           {}: {}: {}\n", r.variant, name_of(r.status), r.reason);
  }
  flush_data();
}

/// Collects the results of the cases and prints each stage when it is complete.
class Results {
 public:
  Results(const verify::Cases& cases, bool prints)
      : cases_(cases), prints_(prints), progress_("check", cases.size()) {}

  void add(const CheckResults& results) {
    all_.insert(all_.end(), results.begin(), results.end());
    by_case_.push_back(results);
    const Stage stage = cases_[done_++].stage;
    reach(done_);
    if (done_ < cases_.size() && cases_[done_].stage == stage) return;
    if (prints_)
      print(name_of(stage), {all_.begin() + static_cast<std::ptrdiff_t>(printed_), all_.end()});
    printed_ = all_.size();
  }
  void reach(std::size_t count) { progress_.reach(count); }
  const CheckResults& all() const { return all_; }
  const std::vector<CheckResults>& by_case() const { return by_case_; }

 private:
  const verify::Cases& cases_;
  bool prints_;
  Progress progress_;
  std::size_t done_ = 0, printed_ = 0;
  CheckResults all_;
  std::vector<CheckResults> by_case_;
};

std::vector<std::string> helper_arguments(const verify::CheckChoice& choice, const Shared& shared) {
  std::vector<std::string> arguments = choice.arguments();
  if (!shared.device.empty()) arguments.push_back("--device=" + shared.device);
  arguments.push_back("--quiet");
  return arguments;
}

/// Runs the cases in helpers. A single one runs in this process, which a debugger or an interpreter
/// watches, and so do all where there is no program to start, as in tests. With capsules, even a
/// single one may crash.
void run_cases(const verify::Cases& cases, const Options& options, const Shared& shared,
               const Device& device, Results& results) {
  const auto add = [&](const CheckResults& found) { results.add(found); };
  if ((cases.size() < 2 && options.capsules.empty()) || !has_helper_program()) {
    Session session(device);
    verify::run_here(cases, session, add);
  } else {
    verify::run_in_helpers(cases, helper_arguments(options.choice, shared), options.limit, add,
                           [&](std::size_t count) { results.reach(count); });
  }
}

CheckResults run_recorded(const verify::Case& compared, const Device& device,
                          const std::filesystem::path& folder) {
  Session session(device);
  session.record(verify::Capsules::recording_of(folder, compared));
  return verify::run_case(compared, session);
}

/// Numbers of the cases that the user named, and of all that are wrong or failed.
std::vector<std::size_t> recorded_cases(const verify::Cases& cases, const Options& options,
                                        const std::vector<CheckResults>& results) {
  std::vector<std::size_t> numbers;
  for (std::size_t i = 0; i < cases.size(); ++i) {
    const bool faulty = count(results[i], Status::wrong) + count(results[i], Status::failed) > 0;
    if (faulty || std::ranges::count(options.capsule, title_of(cases[i])) > 0) numbers.push_back(i);
  }
  return numbers;
}

/// Runs the cases again, recorded, each in a session of its own, and writes their capsules. Warns
/// of those that cannot be written, and returns their number.
std::size_t write_capsules(verify::Capsules& capsules, const verify::Cases& cases,
                           const Options& options, const Shared& shared, const Device& device,
                           const Results& results) {
  verify::CheckChoice choice = options.choice;
  choice.only = recorded_cases(cases, options, results.by_case());
  if (choice.only.empty()) return 0;
  const verify::Cases recorded = choice.cases();
  for (const verify::Case& c : recorded) capsules.begin(c);
  std::size_t done = 0, lost = 0;
  const auto finish = [&](const CheckResults& found) {
    const verify::Case& c = recorded[done];
    const CheckResults& checked = results.by_case()[choice.only[done++]];
    try {
      log_info("capsule of {}: {}", title_of(c),
               capsules.finish(c, device, checked, found).string());
    } catch (const Error& error) {
      log_warning("no capsule of {}: {}", title_of(c), error.what());
      ++lost;
    }
  };
  if (!has_helper_program()) {
    for (const verify::Case& c : recorded) finish(run_recorded(c, device, options.capsules));
    return lost;
  }
  std::vector<std::string> arguments = helper_arguments(choice, shared);
  arguments.push_back("--record=" + options.capsules);
  verify::run_in_helpers(recorded, arguments, options.limit, finish);
  return lost;
}

/// Work of a helper process.
void help(const verify::Cases& cases, const Options& options, const Device& device) {
  become_helper();
  Session session(device);
  const auto run = [&](const verify::Case& compared) {
    return options.record.empty() ? verify::run_case(compared, session)
                                  : run_recorded(compared, device, options.record);
  };
  verify::help(cases, run, Claims(options.claims));
}

void require_known(const std::vector<std::string>& names, const verify::Cases& cases) {
  for (const std::string& name : names)
    if (std::ranges::count(cases, name, title_of) == 0)
      throw Error(ExitCode::usage,
                  "--capsule {}: no comparison has that name; allowed: STAGE NAME of clpv check "
                  "--list, such as '{}'",
                  name, title_of(cases.front()));
}

nlohmann::json report_of(const CheckResults& results, const Device& device) {
  nlohmann::json counts, checks = nlohmann::json::array();
  for (const Status status : values_of<Status>())
    counts[std::string(name_of(status))] = count(results, status);
  for (const CheckResult& result : results) checks.push_back(verify::to_json(result));
  return {{"schema", 1},
          {"device", to_json(device)},
          {"passed", verify::passed(results)},
          {"counts", counts},
          {"checks", checks}};
}

void run(const Options& options, const Shared& shared) {
  check_outputs({{"--junit", options.junit}});
  const verify::Cases cases = options.choice.cases();
  if (options.list) {
    for (const verify::Case& c : cases) print_data("{:<10} {}\n", name_of(c.stage), c.name);
    return;
  }
  require_known(options.capsule, cases);
  const Device device = choose_device(shared.device);
  if (!options.claims.empty()) return help(cases, options, device);
  std::optional<verify::Capsules> capsules;
  if (!options.capsules.empty()) capsules.emplace(options.capsules);
  log_info("checking {} ({}), driver {}: {} comparisons", device.name, device.platform,
           device.driver, cases.size());
  const bool json = options.format == "json";
  Results found(cases, !json);
  run_cases(cases, options, shared, device, found);
  const CheckResults& results = found.all();
  if (json)
    print_json(report_of(results, device).dump(2) + "\n");
  else
    print_data("{} comparisons, {} results: {}\n", cases.size(), results.size(),
               counts_of(results));
  if (!options.junit.empty()) write_file(options.junit, verify::junit(results, device.name));
  const std::size_t lost =
      capsules ? write_capsules(*capsules, cases, options, shared, device, found) : 0;
  if (!verify::passed(results))
    throw Error(ExitCode::validation,
                "results on {}: {}; allowed: none wrong or failed, at least one ok", device.name,
                counts_of(results));
  if (lost > 0)
    throw Error(ExitCode::run_time, "--capsules {}: {} could not be written", options.capsules,
                lost);
}

}  // namespace check_command

void add_check(CLI::App& app, Shared& shared) {
  using namespace check_command;
  CLI::App* command = app.add_subcommand(
      "check", "Compare every stage's kernels with double-precision CPU references on this device");
  auto options = std::make_shared<check_command::Options>();
  add_choices(*command, "--stage", options->choice.stages, "stages to check (default: all)");
  CLI::Option* thorough =
      command->add_flag("--thorough", options->choice.thorough,
                        "all combinations of bases, formats, lobes, tables, transports, states and "
                        "directions; takes minutes. Without it, each path of a kernel once: one "
                        "basis of each kind, each layout and number format");
  const auto take_preset = [options](const std::string& name) {
    options->choice.preset = named<PresetName>("--preset", name);
  };
  command
      ->add_option_function<std::string>(
          "--preset", take_preset,
          "instead: injection, propagation and gathering with the options of this preset together")
      ->check(CLI::IsMember(names_of<PresetName>()))
      ->excludes(thorough);
  command
      ->add_option(
          "--match", options->choice.match,
          "only comparisons with this text in their name, such as a basis or layout; repeatable")
      ->type_name("TEXT");
  add_number(*command, "--limit", "SECONDS", options->limit,
             "timeout per comparison, if several run [s]", {1e-3, 1e6, "0.001..1e6 s"});
  command->add_flag("--list", options->list, "print the names of the comparisons and end");
  add(*command, "--claims", "DIR", options->claims, "folder shared with other helpers")->group("");
  CLI::Option* capsules =
      add(*command, "--capsules", "DIR", options->capsules,
          "new folder for a capsule of each comparison that is wrong or failed: a folder that "
          "replays it without clpv");
  add(*command, "--capsule", "NAME", options->capsule,
      "also a capsule of this comparison, 'STAGE NAME' of --list; repeatable")
      ->needs(capsules);
  add(*command, "--record", "DIR", options->record, "folder of the capsules")->group("");
  const auto only = [options](const std::vector<std::string>& numbers) {
    for (const std::string& number : numbers)
      options->choice.only.push_back(option_number<std::size_t>("--only", number, {0, 1e6}));
  };
  command->add_option_function<std::vector<std::string>>("--only", only, "numbers of comparisons")
      ->group("");
  add_format(*command, options->format);
  add(*command, "--junit", "FILE.xml", options->junit,
      "output file in JUnit format, one test case per result");
  command->footer(
      "A comparison is ok, wrong (beyond its tolerance), failed (the driver reported an error, "
      "crashed, or took too long)\n"
      "or unsupported (the device lacks a capability). Exit code 5 if one is wrong or failed, or "
      "none is ok.");
  command->callback([options, &shared] { run(*options, shared); });
}

}  // namespace clpv
