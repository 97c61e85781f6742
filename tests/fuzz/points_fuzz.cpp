// SPDX-License-Identifier: MIT
// A file of points for clpv query.
#include "scene/points_file.hpp"
#include "tests/fuzz/fuzz.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace clpv;
  const auto path = fuzz::folder().write("points.csv", fuzz::text_of(data, size));
  fuzz::read_or_reject({ExitCode::bad_input}, [&] { read_points(path); });
  return 0;
}
