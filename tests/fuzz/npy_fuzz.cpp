// SPDX-License-Identifier: MIT
// An array of NumPy's: what is read has as many values as its shape says.
#include "support/npy.hpp"
#include "tests/fuzz/fuzz.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace clpv;
  const auto path = fuzz::folder().write("array.npy", fuzz::text_of(data, size));
  fuzz::read_or_refuse({ExitCode::bad_input}, [&] {
    const NpyArray array = read_npy(path);
    std::size_t count = 1;
    for (const std::size_t extent : array.shape) count *= extent;
    if (count != array.values.size()) std::abort();
  });
  return 0;
}
