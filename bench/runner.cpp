// SPDX-License-Identifier: MIT
#include "bench/runner.hpp"

#include <benchmark/benchmark.h>
#include <sys/resource.h>

#include <chrono>
#include <map>
#include <string>

#include "support/error.hpp"
#include "support/interrupt.hpp"
#include "support/log.hpp"

namespace clpv::bench {
namespace {

using Clock = std::chrono::steady_clock;

double since(Clock::time_point start) {
  return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

/// A case under way.
struct Running {
  Row row;
  Job job;
  std::vector<double> wall_ms;
};

/// Takes Google Benchmark's results in place of printing them.
class Collector : public benchmark::BenchmarkReporter {
 public:
  bool ReportContext(const Context&) override { return true; }
  void ReportRuns(const std::vector<Run>& runs) override {
    for (const Run& run : runs) {
      if (run.run_type != Run::RT_Iteration) continue;
      if (run.error_occurred && interrupted()) continue;  // run_cases tells
      if (run.error_occurred)
        throw Error(ExitCode::run_time, "{}: {}", run.run_name.str(), run.error_message);
      cpu_ms[run.run_name.function_name].push_back(run.GetAdjustedCPUTime());
    }
  }
  std::map<std::string, std::vector<double>> cpu_ms;
};

/// Google Benchmark is set by flags alone.
void set_up_library() {
  static std::string program = "clpv", interleave = "--benchmark_enable_random_interleaving=true";
  static char* arguments[] = {program.data(), interleave.data(), nullptr};
  int count = 2;
  benchmark::Initialize(&count, arguments);
}

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

/// Work of a row, under its watch where there is one.
template <typename Work>
auto watched(const RunnerOptions& options, const std::string& row, const Work& work) {
  return options.watch != nullptr ? options.watch->watched(row, work) : work();
}

/// The most memory that the process had so far [bytes].
std::size_t most_host_bytes() {
  rusage usage{};
  ::getrusage(RUSAGE_SELF, &usage);
  return static_cast<std::size_t>(usage.ru_maxrss) * 1024;
}

/// Sets a case up and warms it up; false where the device lacks something.
bool prepare(Session& session, const Case& described, Running& running) {
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
  return running.row.status == Status::ok;
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

void conclude(Running& running, const std::vector<double>& cpu_ms, const RunnerOptions& options) {
  Row& row = running.row;
  row.times = statistics_of(row.samples_ms);
  row.wall_ms = statistics_of(running.wall_ms).median;
  for (const double ms : cpu_ms) row.cpu_ms += ms / static_cast<double>(cpu_ms.size());
  row.cost = running.job.cost;
  row.host_bytes = most_host_bytes();
  if (options.ceilings != nullptr) bind(*options.ceilings, row);
  verify(running);
}

void register_case(Session& session, Running& running, const RunnerOptions& options) {
  benchmark::RegisterBenchmark(running.row.name.c_str(),
                               [&session, &running, &options](benchmark::State& state) {
                                 for ([[maybe_unused]] const auto step : state) {
                                   if (interrupted()) {
                                     state.SkipWithError("interrupted");
                                     break;
                                   }
                                   const double ms = watched(options, running.row.name,
                                                             [&] { return run_once(session, running); });
                                   running.row.samples_ms.push_back(ms);
                                   state.SetIterationTime(ms * 1e-3);
                                 }
                                 if (options.progress != nullptr) options.progress->advance();
                               })
      ->UseManualTime()
      ->MeasureProcessCPUTime()
      ->Iterations(1)
      ->Repetitions(options.repetitions)
      ->Unit(benchmark::kMillisecond);
}

}  // namespace

std::vector<Row> run_cases(Session& session, const std::vector<Case>& cases, const RunnerOptions& options) {
  set_up_library();
  std::vector<Running> running(cases.size());  // stays in place: registered functions refer to it
  bool any = false;
  for (std::size_t i = 0; i < cases.size(); ++i) {
    spdlog::debug("{}", cases[i].row.name);
    stop_if_interrupted("the rows that were done are in the log, if one was asked for");
    if (options.log != nullptr) options.log->begun(cases[i].row.name);
    if (watched(options, cases[i].row.name, [&] { return prepare(session, cases[i], running[i]); })) {
      register_case(session, running[i], options);
      any = true;
    }
    if (options.progress != nullptr) options.progress->advance();
  }
  Collector collector;
  if (any) benchmark::RunSpecifiedBenchmarks(&collector, std::string("all"));
  benchmark::ClearRegisteredBenchmarks();
  stop_if_interrupted("the rows that were done are in the log, if one was asked for");
  std::vector<Row> rows;
  const auto keep = [&](const Row& row) {
    rows.push_back(row);
    if (options.log != nullptr) options.log->done(row);
  };
  for (Running& done : running) {
    done.row.device_bytes = session.most_device_bytes();
    if (done.row.status == Status::ok) conclude(done, collector.cpu_ms[done.row.name], options);
    keep(done.row);
    if (done.row.status != Status::ok || !done.job.more_rows) continue;
    for (const Row& row : done.job.more_rows(done.row)) keep(row);
  }
  return rows;
}

}  // namespace clpv::bench
