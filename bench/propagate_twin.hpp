// Propagation in double, row by row: what host/reference/propagate does cell by cell, fast enough for the sizes that
// are timed. tests/bench_test.cpp holds the two against each other.
#pragma once

#include <vector>

#include "basis/basis.hpp"
#include "basis/transport.hpp"
#include "reference/volume.hpp"

namespace clpv::bench {

/// The accumulated light after `iterations` steps, in Volume's host order; the first step does not block. As
/// reference::propagate, with clamping.
std::vector<double> propagated(const Transport& transport, const reference::Volume& injected,
                               const reference::Volume* geometry, int iterations);

}  // namespace clpv::bench
