// SPDX-License-Identifier: MIT
// The device that tests run on.
#pragma once

#include "device/session.hpp"

namespace clpv::test {

/// One session a process: kernels that several tests use are built once.
inline Session& test_session() {
  // Never released: a driver's own statics may be gone before a static session is.
  static Session* const session = new Session(choose_device());
  return *session;
}

}  // namespace clpv::test
