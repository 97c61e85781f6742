// SPDX-License-Identifier: MIT
// The table of comparisons of kernels with their double-precision CPU references, on any device;
// `clpv check` and tests run it.
#pragma once

#include <cmath>
#include <cstddef>
#include <functional>
#include <glm/glm.hpp>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "basis/basis.hpp"
#include "device/session.hpp"
#include "options/render_options.hpp"
#include "options/stages.hpp"
#include "verify/job.hpp"
#include "volume/volume_format.hpp"

namespace clpv::verify {

/// Result of one comparison.
struct CheckResult {
  std::string stage;         ///< "propagate"
  std::string variant;       ///< name of the case, and of the result where a case has several
  Deviation deviation = {};  ///< with status `ok` and `wrong`
  Status status = Status::ok;
  /// With status `failed` and `unsupported`: the driver's words, or the exceeded limit.
  std::string reason = {};
  double seconds = 0;  ///< time of the case, with building its kernels, per result
  bool passed() const { return status == Status::ok; }
};
using CheckResults = std::vector<CheckResult>;

/// Returns a result with the status of its deviation.
CheckResult result_of(std::string_view stage, const std::string& variant,
                      const Deviation& deviation);

/// Returns a result of status `failed` or `unsupported`, for a reason.
CheckResult result_of(std::string_view stage, const std::string& variant, Status status,
                      const std::string& reason);

/// One case of the table. Nothing is built before compare() is called.
struct Case {
  Stage stage;
  std::string name;
  std::function<CheckResults(Session&)> compare;
};
using Cases = std::vector<Case>;

/// Returns a case with one deviation.
Case deviation_case(Stage stage, const std::string& name,
                    const std::function<Deviation(Session&)>& compare);
/// Returns a case that runs a job once.
Case job_case(Stage stage, const std::string& name, const std::function<Job(Session&)>& make);

/// Scope of a check. The default covers each path of a kernel once: one basis of each kind of code
/// (harmonics, radial functions with and without opposite centres, bins), each volume layout and
/// each number format. It omits variants that differ only in constants (exact face fluxes of all
/// bases, further directions and grid sizes) and combinations of basis, format and option;
/// `thorough` has them. Building kernels is nearly all of the time.
struct CheckScope {
  bool thorough = false;  ///< every combination of basis and options
  std::vector<std::string> bases = {"sh2", "sh3", "srbf4", "srbf8v2", "bins24"};
  /// Volume formats beside the default.
  std::vector<VolumeFormat> formats = {{Layout::soa, Storage::float16},
                                       {Layout::aos, Storage::float32},
                                       {Layout::tiled, Storage::float16},
                                       {Layout::image, Storage::float16}};
};

/// Every combination of bases, formats and options.
CheckScope thorough_scope();

/// Returns the cases of one stage, in a fixed order.
Cases cases_of(Stage stage, const CheckScope& scope = {});

/// Returns the cases of injection, propagation and gathering with exactly these options.
Cases cases_of(const RenderOptions& options);

/// Runs one case. A capability that the device lacks gives Status::unsupported, any other error
/// Status::failed. Throws Interrupted.
CheckResults run_case(const Case& compared, Session& session);

/// Returns true if a result is ok, and none wrong or failed: a device without any capability does
/// not pass.
bool passed(const CheckResults& results);

// One function per stage, in host/verify/.
using StageCases = Cases(const CheckScope& scope);
StageCases sizes_cases, rasterize_cases, emit_cases, inject_cases, blockers_cases, reflectors_cases,
    propagate_cases, sweep_cases, bounce_cases, visibility_cases, gather_cases, near_cases,
    medium_cases, shade_cases;

// Writes comparisons as test cases in JUnit XML, which build servers read.

/// Writes one <testsuite> per stage, in order, and one <testcase> per result. Wrong results are
/// failures with error and place, failed ones errors, unsupported ones skipped. Without a result
/// that is ok, one more test case is an error, since servers take skipped ones for good.
std::string junit(CheckResults results, const std::string& device);

// Errors between results and their CPU references.

/// Largest of the recorded errors. A NaN exceeds any number and stays.
struct WorstError {
  double value = 0;
  std::size_t at = 0;  ///< index of the largest error

  /// Returns true if `error` is the largest so far.
  bool take(double error, std::size_t index) {
    if (std::isnan(value) || error <= value) return false;
    value = error, at = index;
    return true;
  }
};

/// Returns the largest difference of `count` values found(i) and wanted(i), relative to the largest
/// |wanted|.
template <typename Found, typename Wanted>
WorstError worst_difference(std::size_t count, const Found& found, const Wanted& wanted) {
  double largest = 0;
  for (std::size_t i = 0; i < count; ++i)
    largest = std::max(largest, std::abs(static_cast<double>(wanted(i))));
  WorstError worst;
  for (std::size_t i = 0; i < count; ++i) worst.take(std::abs(found(i) - wanted(i)) / largest, i);
  return worst;
}

/// Compares volumes of n^3 samples in Volume's host order, relative to the largest expected value.
Deviation compare_volumes(std::span<const float> found, std::span<const double> expected, int n,
                          double allowed = 0);

/// Returns the 26 directions of compare_functions().
std::vector<glm::dvec3> compared_directions();

/// Compares the functions that volumes represent, in 26 directions. With an ill-conditioned Gram
/// matrix, coefficients differ while the functions agree. `numbers`: values per sample and channel.
/// `weights`: their weights in a direction. `other`: a second reference result, as accurate as
/// `expected`.
Deviation compare_functions(std::span<const float> found, std::span<const double> expected,
                            std::span<const double> other, int n, int numbers,
                            const std::function<std::vector<double>(const glm::dvec3&)>& weights,
                            double allowed = 0);

}  // namespace clpv::verify
