// SPDX-License-Identifier: MIT
// Stands in for libFuzzer's main: gives a target each file of a folder, then mutants of them for some seconds.
//
//   fuzz_NAME FOLDER SECONDS
//
// The mutants are the same in every run: a test that failed fails again. The input in hand lies in a file, which stays when it
// ends the program.
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <random>
#include <string>
#include <vector>

#include "tests/fuzz/fuzz.hpp"
#include "tests/fuzz/mutant.hpp"
#include "tests/support/run_program.hpp"

namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

constexpr const char* kInHand = "in_hand";

std::vector<std::string> corpus_in(const fs::path& folder) {
  std::vector<fs::path> files;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder)) files.push_back(entry.path());
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
  std::mt19937_64 random;  // of the usual seed
  std::size_t mutants = 0;
  for (; Clock::now() < end; ++mutants) try_input(clpv::fuzz::mutant(corpus, random));
  std::printf("%zu inputs, %zu mutants\n", corpus.size(), mutants);
  return 0;
}
