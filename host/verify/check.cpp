// SPDX-License-Identifier: MIT
#include "verify/check.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>

#include "device/cl_error.hpp"
#include "support/interrupt.hpp"
#include "support/text.hpp"

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
  const double seconds = ms_since(start) / 1000;
  for (CheckResult& result : results)
    result.seconds = seconds / static_cast<double>(results.size());
  return results;
}

bool passed(const CheckResults& results) {
  const auto has = [&](Status status) {
    return std::ranges::count(results, status, &CheckResult::status) > 0;
  };
  return has(Status::ok) && !has(Status::wrong) && !has(Status::failed);
}

namespace {

std::string test_case(const CheckResult& result) {
  const std::string head =
      fmt::format("    <testcase classname=\"clpv.{}\" name=\"{}\" time=\"{:.6f}\"",
                  xml_escaped(result.stage), xml_escaped(result.variant), result.seconds);
  const auto with = [&](const std::string& element) {
    return fmt::format("{}>\n      {}\n    </testcase>\n", head, element);
  };
  switch (result.status) {
    case Status::ok:
      return head + "/>\n";
    case Status::wrong:
      return with(fmt::format("<failure message=\"{:.3e} &gt; {:.0e}\">{}</failure>",
                              result.deviation.worst, result.deviation.allowed,
                              xml_escaped(result.deviation.place)));
    case Status::failed:
      return with(fmt::format("<error>{}</error>", xml_escaped(result.reason)));
    case Status::unsupported:
      return with(fmt::format("<skipped message=\"{}\"/>", xml_escaped(result.reason)));
  }
  return {};
}

/// The counts of a suite, as attributes.
std::string counts(CheckResults::const_iterator first, CheckResults::const_iterator last) {
  const auto of = [&](Status status) {
    return std::count_if(first, last,
                         [&](const CheckResult& result) { return result.status == status; });
  };
  return fmt::format("tests=\"{}\" failures=\"{}\" errors=\"{}\" skipped=\"{}\"", last - first,
                     of(Status::wrong), of(Status::failed), of(Status::unsupported));
}

}  // namespace

std::string junit(CheckResults results, const std::string& device) {
  if (std::ranges::none_of(results, &CheckResult::passed))
    results.push_back(
        result_of("check", "at least one comparison is ok", Status::failed, "none is"));
  std::string text = fmt::format(
      "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<testsuites name=\"clpv check on {}\" {}>\n",
      xml_escaped(device), counts(results.begin(), results.end()));
  for (auto first = results.begin(); first != results.end();) {
    const auto last = std::find_if(first, results.end(), [&](const CheckResult& result) {
      return result.stage != first->stage;
    });
    text += fmt::format("  <testsuite name=\"{}\" {}>\n", xml_escaped(first->stage),
                        counts(first, last));
    for (; first != last; ++first) text += test_case(*first);
    text += "  </testsuite>\n";
  }
  return text + "</testsuites>\n";
}

Deviation compare_volumes(std::span<const float> found, std::span<const double> expected, int n,
                          double allowed) {
  const WorstError worst = worst_difference(
      expected.size(), [&](std::size_t i) { return static_cast<double>(found[i]); },
      [&](std::size_t i) { return expected[i]; });
  if (worst.value == 0) return {0, allowed};
  const std::size_t side = n;
  const std::size_t at = worst.at;
  return {
      worst.value, allowed,
      fmt::format("cell {},{},{} plane {}: {:.7g}, expected {:.7g}", at % side, at / side % side,
                  at / side / side % side, at / side / side / side, found[at], expected[at])};
}

std::vector<glm::dvec3> compared_directions() {
  std::vector<glm::dvec3> directions;
  for (int neighbour = 0; neighbour < 27; ++neighbour) {
    if (neighbour == 13) continue;  // the cell itself
    directions.push_back(
        glm::normalize(glm::dvec3(neighbour % 3 - 1, neighbour / 3 % 3 - 1, neighbour / 9 - 1)));
  }
  return directions;
}

Deviation compare_functions(std::span<const float> found, std::span<const double> expected,
                            std::span<const double> other, int n, int numbers,
                            const std::function<std::vector<double>(const glm::dvec3&)>& weights,
                            double allowed) {
  const std::size_t side = n, samples = side * side * side, size = numbers;
  double largest = 0;
  WorstError worst;
  Deviation result{0, allowed};
  for (const glm::dvec3& w : compared_directions()) {
    const std::vector<double> b = weights(w);
    for (std::size_t at = 0; at < found.size() / size; ++at) {
      double value = 0, wanted = 0, or_wanted = 0;
      for (std::size_t i = 0; i < size; ++i) {
        const std::size_t index = (at / samples * size + i) * samples + at % samples;
        value += b[i] * found[index];
        wanted += b[i] * expected[index];
        or_wanted += b[i] * other[index];
      }
      largest = std::max(largest, std::abs(wanted));
      if (!worst.take(std::min(std::abs(value - wanted), std::abs(value - or_wanted)), at))
        continue;
      result.place = fmt::format(
          "cell {},{},{} channel {} towards {:.2f},{:.2f},{:.2f}: {:.7g}, expected {:.7g}",
          at % side, at / side % side, at / side / side % side, at / samples, w.x, w.y, w.z, value,
          wanted);
    }
  }
  result.worst = worst.value / largest;
  return result;
}

}  // namespace clpv::verify
