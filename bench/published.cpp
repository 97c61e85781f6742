// SPDX-License-Identifier: MIT
#include "bench/published.hpp"

namespace clpv::bench {

std::optional<double> published_ms(Pass pass, std::string_view basis, bool shadows,
                                   std::optional<int> cascade) {
  for (const PublishedTimes& times : kPublishedTimes) {
    if (times.basis != basis || times.shadows != shadows) continue;
    if (pass == Pass::gather && !cascade) return times.light_buffer;
    const bool one = cascade && *cascade >= 0 && *cascade < static_cast<int>(times.injection.size());
    if (one && pass == Pass::inject_light) return times.injection[static_cast<std::size_t>(*cascade)];
    if (one && pass == Pass::propagate) return times.propagation[static_cast<std::size_t>(*cascade)];
  }
  return std::nullopt;
}

}  // namespace clpv::bench
