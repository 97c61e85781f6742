// SPDX-License-Identifier: MIT
// Runs the cases of a suite: setup, warm-up, interleaved repetitions, verification.
#include "bench/runner.hpp"

#include <sys/resource.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <ctime>
#include <nlohmann/json.hpp>
#include <random>
#include <string>

#include "support/error.hpp"
#include "support/interrupt.hpp"
#include "support/log.hpp"

namespace clpv::bench {
namespace {

using Clock = std::chrono::steady_clock;

constexpr const char* kFinishedRows = "finished rows are in the file of --log, if given";

/// A case that is set up, and its measurements so far.
struct CaseRun {
  Row row;
  Job job;
  std::vector<double> wall_ms;
};

/// Runs the work once and returns its time [ms], by the device's events where they are reliable,
/// else by the host's clock.
double run_once(Session& session, CaseRun& run) {
  Job& job = run.job;
  session.timeline().clear();
  if (job.reset) job.reset();
  session.queue().finish();
  session.timeline().clear();
  const auto start = Clock::now();
  if (job.own_stages) {
    job.run();
  } else {
    const StageScope scope(session, {Pass::whole});
    job.run();
  }
  session.timeline().finish(session.queue());
  run.wall_ms.push_back(ms_since(start));
  const bool events = session.timeline().events_valid();
  const std::vector<StageTime> times = session.timeline().times();
  if (events != session.timeline().events_valid()) {  // the same by the host's clock
    run.wall_ms.pop_back();
    return run_once(session, run);
  }
  if (job.after_run) job.after_run(times);
  if (job.own_stages || times.empty() || !times.front().from_events) {
    run.row.from_events = false;
    return run.wall_ms.back();
  }
  double ms = 0;
  for (const StageTime& time : times) ms += time.ms;
  return ms;
}

/// Sets up a case and runs it once. Its row becomes `unsupported` if the device lacks a capability.
void prepare(Session& session, const Case& source, CaseRun& run) {
  run.row = source.row;
  const double build_ms_before = session.programs().build_ms();
  try {
    run.job = source.make();
    const auto start = Clock::now();
    run_once(session, run);
    run.row.first_launch_ms = ms_since(start);
  } catch (const Error& error) {
    if (error.code() != ExitCode::device) throw;
    run.row.status = Status::unsupported;
    run.row.reason = error.what();
  }
  run.row.build_ms = session.programs().build_ms() - build_ms_before;
  run.wall_ms.clear();
}

void verify(CaseRun& run) {
  if (!run.job.compare) return;
  const Deviation deviation = run.job.compare();
  run.row.max_rel_error = deviation.worst;
  run.row.tolerance = deviation.allowed;
  if (deviation.passed()) return;
  run.row.status = Status::wrong;
  run.row.reason = deviation.place;
}

void complete_row(CaseRun& run) {
  Row& row = run.row;
  if (!row.from_events) row.samples_ms = run.wall_ms;  // also where the first were events
  row.times = statistics_of(row.samples_ms);
  row.wall_ms = statistics_of(run.wall_ms).median;
  row.cpu_ms /= static_cast<double>(row.samples_ms.size());
  if (run.job.count) row.host = run.job.count();
  rusage usage{};
  ::getrusage(RUSAGE_SELF, &usage);
  row.host_bytes = static_cast<std::size_t>(usage.ru_maxrss) * 1024;  // the peak so far
  verify(run);
}

/// Runs all repetitions of all supported cases, in a random order from a fixed seed.
void repeat(Session& session, std::vector<CaseRun>& runs, const RunnerOptions& options) {
  std::vector<std::size_t> order;
  for (std::size_t i = 0; i < runs.size(); ++i) {
    if (runs[i].row.status == Status::ok)
      order.insert(order.end(), static_cast<std::size_t>(options.repetitions), i);
  }
  std::shuffle(order.begin(), order.end(), std::mt19937(1));
  for (const std::size_t i : order) {
    stop_if_interrupted(kFinishedRows);
    Row& row = runs[i].row;
    const std::clock_t before = std::clock();  // processor time of all threads
    row.samples_ms.push_back(run_once(session, runs[i]));
    row.cpu_ms += 1e3 * static_cast<double>(std::clock() - before) / CLOCKS_PER_SEC;
    if (options.progress != nullptr) options.progress->advance();
  }
}

std::vector<Case> filtered(std::vector<Case> cases, const std::optional<std::regex>& filter) {
  if (filter)
    std::erase_if(cases, [&](const Case& c) { return !std::regex_search(c.row.name, *filter); });
  return cases;
}

}  // namespace

RowLog::RowLog(const std::filesystem::path& file) : file_(file) {
  if (!file_.empty()) out_.open(file_, std::ios::binary | std::ios::trunc);
  check();
}

void RowLog::check() const {
  if (!out_)
    throw Error(ExitCode::run_time, "{}: cannot be written: {}", file_.string(),
                std::strerror(errno));
}

void RowLog::started(const std::string& name) {
  write(nlohmann::json{{"started", name}}.dump());
}

void RowLog::done(const Row& row) {
  write(nlohmann::json{{"row", to_json(row, 0)}}.dump());
}

void RowLog::write(const std::string& line) {
  if (!out_.is_open()) return;
  out_ << line << '\n' << std::flush;  // reaches the system before a crash
  check();
}

std::vector<Row> run_cases(Session& session, const std::vector<Case>& cases,
                           const RunnerOptions& options) {
  std::vector<CaseRun> runs(cases.size());
  for (std::size_t i = 0; i < cases.size(); ++i) {
    log_debug("{}", cases[i].row.name);
    stop_if_interrupted(kFinishedRows);
    if (options.log != nullptr) options.log->started(cases[i].row.name);
    prepare(session, cases[i], runs[i]);
    if (options.progress != nullptr) options.progress->advance();
  }
  repeat(session, runs, options);
  if (!session.timeline().events_valid())  // what was measured before is not believed either
    for (CaseRun& run : runs) run.row.from_events = false;
  std::vector<Row> rows;
  const auto add = [&](const Row& row) {
    rows.push_back(row);
    if (options.log != nullptr) options.log->done(row);
  };
  for (CaseRun& run : runs) {
    run.row.device_bytes = session.peak_device_bytes();
    if (run.row.status == Status::ok) complete_row(run);
    add(run.row);
    if (run.row.status != Status::ok || !run.job.more_rows) continue;
    for (const Row& row : run.job.more_rows(run.row)) add(row);
  }
  return rows;
}

std::vector<Row> run_suite(Session& session, const Suite& suite, const BenchOptions& options) {
  // Own what cases refer to.
  std::vector<Group> selected;
  std::size_t count = 0;
  for (Group& group : suite.groups(session, options.suite)) {
    selected.push_back(filtered(std::move(group), options.filter));
    count += selected.back().size();
  }
  if (count == 0) throw Error(ExitCode::usage, "--filter: matches no row of suite {}", suite.name);
  Progress progress("bench " + suite.name,
                    count * static_cast<std::size_t>(options.repetitions + 1));
  RowLog log(options.log);
  std::vector<Row> rows;
  for (Group& cases : selected) {
    std::ranges::move(run_cases(session, cases, {options.repetitions, &progress, &log}),
                      std::back_inserter(rows));
    cases.clear();
  }
  return rows;
}

}  // namespace clpv::bench
