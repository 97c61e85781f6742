// SPDX-License-Identifier: MIT
// A line of times.jsonl: skipped, or a frame's times that are written as they were read.
#include <cstdlib>
#include <nlohmann/json.hpp>

#include "sequence/times_file.hpp"
#include "tests/fuzz/fuzz.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace clpv;
  const auto line = frame_line(std::string(fuzz::text_of(data, size)));
  if (!line) return 0;
  const std::string written = to_json(*line).dump();
  const auto again = frame_line(written);
  if (!again || to_json(*again).dump() != written || line->frame < 0) std::abort();
  return 0;
}
