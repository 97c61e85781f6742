// SPDX-License-Identifier: MIT
// The device that tests run on, and options of frames whose programs they share.
#pragma once

#include "device/session.hpp"
#include "options/render_options.hpp"

namespace clpv::test {

/// One session a process: kernels that several tests use are built once.
inline Session& test_session() {
  // Never released: a driver's own statics may be gone before a static session is.
  static Session* const session = new Session(choose_device());
  return *session;
}

/// The options of kSmallSweep (scenes.hpp).
inline RenderOptions small_sweep() {
  RenderOptions options;
  options.grid = 16;
  options.directions = options.coarser_directions = Directions::of24;
  return options;
}

}  // namespace clpv::test
