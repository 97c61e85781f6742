// SPDX-License-Identifier: MIT
// A file of --centres, up to the basis that is made of it.
#include "basis/basis.hpp"
#include "tests/fuzz/fuzz.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace clpv;
  const auto path = fuzz::folder().write("centres.json", fuzz::text_of(data, size));
  // Equal centres are an error of usage: lambda may come from the command line.
  fuzz::read_or_reject({ExitCode::bad_input, ExitCode::usage}, [&] { load_basis(path.string()); });
  return 0;
}
