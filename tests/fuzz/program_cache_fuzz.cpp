// SPDX-License-Identifier: MIT
// A file of a compiled program, with a right hash put on where the first byte is odd: taken whole
// or not at all, never an error. A program that is taken is the one in the file.
#include <string>

#include "device/program_cache.hpp"
#include "support/fingerprint.hpp"
#include "support/log.hpp"
#include "tests/fuzz/fuzz.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace clpv;
  static const bool quiet = (log_to_stderr(clpv::LogLevel::error), true);
  static_cast<void>(quiet);
  if (size == 0) return 0;
  std::string bytes(fuzz::text_of(data + 1, size - 1));
  if (data[0] & 1) {
    bytes.insert(0, "clpv program 2\n");
    const std::uint64_t hash = Fingerprint().add(std::string_view(bytes)).value();
    bytes.append(reinterpret_cast<const char*>(&hash), sizeof hash);
  }
  const ProgramCache cache(fuzz::folder().path());
  fuzz::folder().write(cache.file_of("key").filename().string(), bytes);
  const auto binary = cache.load("key");
  if (binary && binary->size() > bytes.size()) std::abort();
  return 0;
}
