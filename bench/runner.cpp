// SPDX-License-Identifier: MIT
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

constexpr const char* kKept = "the rows that were done are in the log, if one was asked for";

double since(Clock::time_point start) {
  return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

/// A case under way.
struct Running {
  Row row;
  Job job;
  std::vector<double> wall_ms;
};

/// The work once: its time [ms], on the device's clock where that is to be trusted.
double run_once(Session& session, Running& running) {
  Job& job = running.job;
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
  session.queue().finish();
  running.wall_ms.push_back(since(start));
  const std::vector<StageTime> times = session.timeline().times();
  if (job.after_run) job.after_run(times);
  if (job.own_stages || times.empty() || !times.front().from_events) {
    running.row.from_events = false;
    return running.wall_ms.back();
  }
  double ms = 0;
  for (const StageTime& time : times) ms += time.ms;
  return ms;
}

/// The most memory that the process had so far [bytes].
std::size_t most_host_bytes() {
  rusage usage{};
  ::getrusage(RUSAGE_SELF, &usage);
  return static_cast<std::size_t>(usage.ru_maxrss) * 1024;
}

/// Sets a case up and warms it up; unsupported where the device lacks something.
void prepare(Session& session, const Case& described, Running& running) {
  running.row = described.row;
  const double built = session.build_ms();
  try {
    running.job = described.make();
    const auto start = Clock::now();
    run_once(session, running);
    running.row.first_launch_ms = since(start);
  } catch (const Error& error) {
    if (error.code() != ExitCode::device) throw;
    running.row.status = Status::unsupported;
    running.row.reason = error.what();
  }
  running.row.build_ms = session.build_ms() - built;
  running.wall_ms.clear();
}

void verify(Running& running) {
  if (!running.job.verify) return;
  const Deviation deviation = running.job.verify();
  running.row.max_rel_error = deviation.worst;
  running.row.tolerance = deviation.tolerance;
  if (deviation.passed()) return;
  running.row.status = Status::wrong;
  running.row.reason = deviation.place;
}

void conclude(Running& running, const RunnerOptions& options) {
  Row& row = running.row;
  row.times = statistics_of(row.samples_ms);
  row.wall_ms = statistics_of(running.wall_ms).median;
  row.cpu_ms /= static_cast<double>(row.samples_ms.size());
  row.cost = running.job.cost;
  row.host_bytes = most_host_bytes();
  if (options.ceilings != nullptr) bind(*options.ceilings, row);
  verify(running);
}

/// Every repetition of all that can be run, in an order that is random but always the same.
void repeat(Session& session, std::vector<Running>& running, const RunnerOptions& options) {
  std::vector<std::size_t> turns;
  for (std::size_t i = 0; i < running.size(); ++i) {
    if (running[i].row.status == Status::ok)
      turns.insert(turns.end(), static_cast<std::size_t>(options.repetitions), i);
  }
  std::shuffle(turns.begin(), turns.end(), std::mt19937(1));
  for (const std::size_t turn : turns) {
    stop_if_interrupted(kKept);
    Row& row = running[turn].row;
    const std::clock_t before = std::clock();  // of all threads
    row.samples_ms.push_back(run_once(session, running[turn]));
    row.cpu_ms += 1e3 * static_cast<double>(std::clock() - before) / CLOCKS_PER_SEC;
    if (options.progress != nullptr) options.progress->advance();
  }
}

std::vector<Case> filtered(std::vector<Case> cases, const std::optional<std::regex>& filter) {
  if (filter) std::erase_if(cases, [&](const Case& c) { return !std::regex_search(c.row.name, *filter); });
  return cases;
}

}  // namespace

RowLog::RowLog(const std::filesystem::path& file) : file_(file) {
  if (!file_.empty()) out_.open(file_, std::ios::binary | std::ios::trunc);
  check();
}

void RowLog::check() const {
  if (!out_)
    throw Error(ExitCode::run_time, "{}: cannot be written: {}", file_.string(), std::strerror(errno));
}

void RowLog::begun(const std::string& name) {
  write(nlohmann::json{{"begun", name}}.dump());
}

void RowLog::done(const Row& row) {
  write(nlohmann::json{{"row", to_json(row, 0)}}.dump());
}

void RowLog::write(const std::string& line) {
  if (!out_.is_open()) return;
  out_ << line << '\n' << std::flush;  // the system has it, whatever becomes of the process
  check();
}

std::vector<Row> run_cases(Session& session, const std::vector<Case>& cases, const RunnerOptions& options) {
  std::vector<Running> running(cases.size());
  for (std::size_t i = 0; i < cases.size(); ++i) {
    spdlog::debug("{}", cases[i].row.name);
    stop_if_interrupted(kKept);
    if (options.log != nullptr) options.log->begun(cases[i].row.name);
    prepare(session, cases[i], running[i]);
    if (options.progress != nullptr) options.progress->advance();
  }
  repeat(session, running, options);
  std::vector<Row> rows;
  const auto keep = [&](const Row& row) {
    rows.push_back(row);
    if (options.log != nullptr) options.log->done(row);
  };
  for (Running& done : running) {
    done.row.device_bytes = session.peak_device_bytes();
    if (done.row.status == Status::ok) conclude(done, options);
    keep(done.row);
    if (done.row.status != Status::ok || !done.job.more_rows) continue;
    for (const Row& row : done.job.more_rows(done.row)) keep(row);
  }
  return rows;
}

Results run_suite(Session& session, const Suite& suite, const BenchOptions& options) {
  const std::vector<Group> groups = suite.groups(session, options.suite);  // cases refer to what they keep
  std::vector<std::vector<Case>> wanted;
  std::size_t count = 0;
  for (const Group& group : groups) {
    wanted.push_back(filtered(group(), options.filter));
    count += wanted.back().size();
  }
  if (count == 0) throw Error(ExitCode::usage, "filter: no row of suite {} matches", suite.name);
  const bool ceilings_asked = suite.name == "ceilings";
  const std::vector<Case> ceilings = ceilings_asked ? std::vector<Case>{} : ceiling_cases(session);
  Progress progress("bench " + suite.name,
                    (count + ceilings.size()) * static_cast<std::size_t>(options.repetitions + 1));
  Results results;
  RowLog log(options.log);
  RunnerOptions runner{options.repetitions, nullptr, &progress, &log};
  if (!ceilings_asked) {
    results.ceilings = ceilings_of(run_cases(session, ceilings, runner));
    runner.ceilings = &results.ceilings;
  }
  for (std::vector<Case>& cases : wanted) {
    std::ranges::move(run_cases(session, cases, runner), std::back_inserter(results.rows));
    cases.clear();
  }
  if (ceilings_asked) results.ceilings = ceilings_of(results.rows);
  return results;
}

}  // namespace clpv::bench
