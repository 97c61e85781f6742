// SPDX-License-Identifier: MIT
// Capsules: folders that replay single comparisons without clpv (docs/devices.md).
#pragma once

#include <filesystem>
#include <set>

#include "verify/check.hpp"

namespace clpv::verify {

/// Capsules below one folder. Each is written beside its place and renamed once it is complete.
class Capsules {
 public:
  /// Makes the folder. Throws Error(usage) if it has content, Error(run_time) if it cannot be made.
  explicit Capsules(std::filesystem::path folder);
  ~Capsules();  ///< removes incomplete capsules
  Capsules(const Capsules&) = delete;
  Capsules& operator=(const Capsules&) = delete;

  /// Makes the folder that a session shall record the case in.
  void begin(const Case& recorded);
  /// Returns that folder, for the capsules of any process.
  static std::filesystem::path recording_of(const std::filesystem::path& folder, const Case& c);

  /// Completes what was recorded, and returns the capsule's folder. `checked`: results of the
  /// comparison without recording; `recorded`: with it. Throws Error(run_time) if it cannot be
  /// written or is too large.
  std::filesystem::path finish(const Case& c, const Device& device, const CheckResults& checked,
                               const CheckResults& recorded);

 private:
  std::filesystem::path folder_;
  std::set<std::filesystem::path> incomplete_;
};

}  // namespace clpv::verify
