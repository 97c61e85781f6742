// SPDX-License-Identifier: MIT
// The device that tests run on, and expectations for results of `clpv check`.
#pragma once

#include <gtest/gtest.h>

#include <string>

#include "device/session.hpp"
#include "verify/check.hpp"

namespace clpv::test {

/// One session a process: kernels that several tests use are built once.
inline Session& test_session() {
  // Never released: a driver's own statics may be gone before a static session is.
  static Session* const session = new Session(choose_device());
  return *session;
}

/// Every case of a check passed, and there are at least `least` of them.
inline void expect_passed(const reference::CheckResults& results, std::size_t least = 1) {
  EXPECT_GE(results.size(), least);
  for (const reference::CheckResult& result : results) {
    EXPECT_TRUE(result.passed()) << result.stage << " " << result.variant << ": " << result.worst
                                 << ", allowed " << result.allowed << "; " << result.place;
  }
}

/// A check's variants that differ in code, not in numbers alone. Bases: harmonics, centres, direction bins. Formats: each
/// layout, and halves.
inline reference::CheckScope few_variants() {
  return {.bases = {"sh2", "srbf4", "bins24"},
          .formats = {{Layout::soa, Storage::float16},
                      {Layout::aos, Storage::float32},
                      {Layout::tiled, Storage::float16},
                      {Layout::image, Storage::float16}}};
}

}  // namespace clpv::test
