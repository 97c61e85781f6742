// SPDX-License-Identifier: MIT
// Errors that a test expects.
#pragma once

#include <gtest/gtest.h>

#include <string>

#include "support/error.hpp"

namespace clpv::test {

/// The message of the Error that `action` throws; its exit code must be `code`.
template <typename Action>
std::string error_of(ExitCode code, Action&& action) {
  try {
    action();
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), code) << error.what();
    return error.what();
  }
  ADD_FAILURE() << "no error";
  return {};
}

}  // namespace clpv::test
