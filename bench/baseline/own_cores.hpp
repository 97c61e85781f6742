// SPDX-License-Identifier: MIT
// OpenMP's threads each on a core of its own.
#pragma once

namespace clpv::bench {

/// Binds them, where there are cores enough and the system can (Linux); to be called once the device's threads are there. Not
/// by OMP_PROC_BIND, which binds the program's first thread at its start, and with it every thread of the OpenCL driver to one core.
void give_threads_own_cores();

}  // namespace clpv::bench
