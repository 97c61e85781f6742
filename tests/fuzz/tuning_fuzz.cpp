// SPDX-License-Identifier: MIT
// A file of what clpv tune found: taken or ignored, never an error.
#include "device/device.hpp"
#include "pipeline/tuning.hpp"
#include "support/log.hpp"
#include "tests/fuzz/fuzz.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace clpv;
  static const bool quiet = (set_log_level(true, 0), true);
  static_cast<void>(quiet);
  const TuningCache cache(fuzz::folder().path());
  const TuningSubject subject{"sh2", TransportKind::sampled, State::coefficients,
                              32,    Storage::float32,       std::nullopt};
  fuzz::folder().write(cache.file_of({}, subject).filename().string(), fuzz::text_of(data, size));
  cache.load({}, subject);
  return 0;
}
