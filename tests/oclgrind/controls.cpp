// SPDX-License-Identifier: MIT
// Runs the kernels of controls.cl. CLPV_KERNEL_DIR names their folder.
#include "device/kernel.hpp"
#include "device/session.hpp"

int main() {
  using namespace clpv;
  constexpr std::size_t kItems = 8, kGroup = 4, kBytes = kItems * sizeof(cl_int);
  Session session(choose_device());
  const ProgramSource source{"controls.cl"};
  const Buffer written = session.buffer(kBytes, "written"),
               unwritten = session.buffer(kBytes, "unwritten");
  session.fill_zero(written, kBytes);

  Kernel(session, source, "sound").set(written).launch(kItems, kGroup);
  Kernel(session, source, "racy").set(written).launch(kItems, kGroup);
  Kernel(session, source, "uninitialised").set(unwritten, written).launch(kItems, kGroup);
  session.queue().finish();
}
