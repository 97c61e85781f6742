// SPDX-License-Identifier: MIT
#include "verify/check.hpp"

#include <algorithm>
#include <chrono>

#include "device/cl_error.hpp"
#include "support/interrupt.hpp"

namespace clpv::verify {
namespace {

constexpr StageCases* kStages[] = {sizes_cases,    rasterize_cases,  emit_cases,      inject_cases,
                                   blockers_cases, reflectors_cases, propagate_cases, sweep_cases,
                                   bounce_cases,   visibility_cases, gather_cases,    near_cases,
                                   medium_cases,   shade_cases};
static_assert(std::size(kStages) == kNames<Stage>.size());

/// Runs the comparison; an error becomes a result.
CheckResults results_of(const Case& compared, Session& session) {
  const auto result = [&](Status status, const char* reason) {
    return CheckResults{result_of(name_of(compared.stage), compared.name, status, reason)};
  };
  const auto of_error = [&](const Error& error) {
    return result(error.code() == ExitCode::device ? Status::unsupported : Status::failed,
                  error.what());
  };
  try {
    return compared.compare(session);
  } catch (const Interrupted&) {
    throw;
  } catch (const Error& error) {
    return of_error(error);
  } catch (const cl::Error& error) {
    return of_error(cl_error(error));
  } catch (const std::exception& error) {
    return result(Status::failed, error.what());
  }
}

}  // namespace

CheckResult result_of(std::string_view stage, const std::string& variant,
                      const Deviation& deviation) {
  return {std::string(stage), variant, deviation, deviation.passed() ? Status::ok : Status::wrong};
}

CheckResult result_of(std::string_view stage, const std::string& variant, Status status,
                      const std::string& reason) {
  CheckResult result;
  result.stage = stage, result.variant = variant;
  result.status = status, result.reason = reason;
  return result;
}

Case deviation_case(Stage stage, const std::string& name,
                    const std::function<Deviation(Session&)>& compare) {
  return {stage, name, [=](Session& session) {
            return CheckResults{result_of(name_of(stage), name, compare(session))};
          }};
}

Case job_case(Stage stage, const std::string& name, const std::function<Job(Session&)>& make) {
  return deviation_case(stage, name, [make](Session& session) {
    const Job job = make(session);
    job.run();
    return job.compare();
  });
}

CheckScope thorough_scope() {
  CheckScope scope{.thorough = true, .bases = basis_names(), .formats = all_formats()};
  std::erase(scope.formats, VolumeFormat{});  // the default, which all other comparisons have
  return scope;
}

Cases cases_of(Stage stage, const CheckScope& scope) {
  return kStages[static_cast<std::size_t>(stage)](scope);
}

CheckResults run_case(const Case& compared, Session& session) {
  const auto start = std::chrono::steady_clock::now();
  CheckResults results = results_of(compared, session);
  const std::chrono::duration<double> all = std::chrono::steady_clock::now() - start;
  for (CheckResult& result : results)
    result.seconds = all.count() / static_cast<double>(results.size());
  return results;
}

bool passed(const CheckResults& results) {
  const auto has = [&](Status status) {
    return std::ranges::count(results, status, &CheckResult::status) > 0;
  };
  return has(Status::ok) && !has(Status::wrong) && !has(Status::failed);
}

}  // namespace clpv::verify
