// SPDX-License-Identifier: MIT
// Stands in for libFuzzer's main: gives a target each file of a folder, then mutants of them for
// some seconds.
//
//   fuzz_NAME FOLDER SECONDS
//
// The mutants are the same in every run: a test that failed fails again. The current input is a
// file, which remains when it ends the program.
#include <algorithm>
#include <array>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <random>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "tests/fuzz/fuzz.hpp"
#include "tests/support/run_program.hpp"

namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;
using Random = std::mt19937_64;

/// As binary files and as texts write them.
constexpr std::array<std::string_view, 14> kEdges = {
    {std::string_view("\0", 1), "\x7f", "\x80", "\xff", std::string_view("\0\0\0\0", 4),
     "\xff\xff\xff\xff", "\xff\xff\xff\x7f", std::string_view("\0\0\0\x80", 4), "-1", "0", "1e999",
     "nan", "4294967296", "18446744073709551615"}};
constexpr std::size_t kMaxSpan = 64;

std::size_t below(std::size_t end, Random& random) {
  return end == 0 ? 0 : random() % end;
}

std::string_view span_of(std::string_view text, Random& random) {
  const std::size_t start = below(text.size() + 1, random);
  return text.substr(start, 1 + below(kMaxSpan, random));
}

/// In place of as many bytes, or of those of a number in digits, or of none.
void put(std::string& text, std::string_view piece, Random& random) {
  const std::size_t start = below(text.size() + 1, random);
  const std::size_t digits =
      std::min(text.find_first_not_of("0123456789", start), text.size()) - start;
  const std::array<std::size_t, 3> lengths = {piece.size(), digits, 0};
  text.replace(start, lengths[below(lengths.size(), random)], piece);
}

void change(std::string& text, std::span<const std::string> inputs, Random& random) {
  switch (below(5, random)) {
    case 0:
      if (!text.empty())
        text[below(text.size(), random)] ^= static_cast<char>(1 << below(8, random));
      break;
    case 1:
      put(text, kEdges[below(kEdges.size(), random)], random);
      break;
    case 2: {
      const std::string_view left_out = span_of(text, random);
      text.erase(static_cast<std::size_t>(left_out.data() - text.data()), left_out.size());
      break;
    }
    case 3:
      put(text, std::string(span_of(text, random)), random);
      break;
    default:
      put(text, span_of(inputs[below(inputs.size(), random)], random), random);
  }
}

/// One of `inputs`, changed in up to four places: bits, numbers on the edge, pieces left out,
/// repeated or of another input.
std::string mutant(std::span<const std::string> inputs, Random& random) {
  std::string text = inputs[below(inputs.size(), random)];
  for (std::size_t changes = 1 + below(4, random); changes > 0; --changes)
    change(text, inputs, random);
  return text;
}

constexpr const char* kInHand = "in_hand";

std::vector<std::string> corpus_in(const fs::path& folder) {
  std::vector<fs::path> files;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder))
    files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  std::vector<std::string> corpus;
  for (const fs::path& file : files) corpus.push_back(clpv::test::read_file(file));
  return corpus;
}

void try_input(const std::string& bytes) {
  clpv::fuzz::folder().write(kInHand, bytes);
  LLVMFuzzerTestOneInput(reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size());
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 3) {
    std::fprintf(stderr, "usage: %s FOLDER SECONDS\n", argv[0]);
    return 2;
  }
  const std::vector<std::string> corpus = corpus_in(argv[1]);
  if (corpus.empty()) {
    std::fprintf(stderr, "%s: no inputs\n", argv[1]);
    return 1;
  }
  std::printf("the input in hand: %s\n", clpv::fuzz::folder().write(kInHand, "").c_str());
  std::fflush(stdout);
  const auto end = Clock::now() + std::chrono::duration<double>(std::stod(argv[2]));
  for (const std::string& input : corpus) try_input(input);
  std::mt19937_64 random;  // with the usual seed
  std::size_t mutants = 0;
  for (; Clock::now() < end; ++mutants) try_input(mutant(corpus, random));
  std::printf("%zu inputs, %zu mutants\n", corpus.size(), mutants);
  return 0;
}
