// SPDX-License-Identifier: MIT
// The table of comparisons of kernels with their double-precision CPU references, on any device;
// `clpv check` and tests run it.
#pragma once

#include <functional>
#include <optional>
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

}  // namespace clpv::verify
