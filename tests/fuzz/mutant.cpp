// SPDX-License-Identifier: MIT
#include "tests/fuzz/mutant.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <string_view>

namespace clpv::fuzz {
namespace {

using Random = std::mt19937_64;

/// As binary files and as texts write them.
constexpr std::array<std::string_view, 14> kEdges = {
    {std::string_view("\0", 1), "\x7f", "\x80", "\xff", std::string_view("\0\0\0\0", 4), "\xff\xff\xff\xff",
     "\xff\xff\xff\x7f", std::string_view("\0\0\0\x80", 4), "-1", "0", "1e999", "nan", "4294967296",
     "18446744073709551615"}};
constexpr std::size_t kMostSpan = 64;

std::size_t below(std::size_t end, Random& random) {
  return end == 0 ? 0 : random() % end;
}

std::string_view span_of(std::string_view text, Random& random) {
  const std::size_t start = below(text.size() + 1, random);
  return text.substr(start, 1 + below(kMostSpan, random));
}

/// In place of as many bytes, or of those of a number in digits, or of none.
void put(std::string& text, std::string_view piece, Random& random) {
  const std::size_t start = below(text.size() + 1, random);
  const std::size_t digits = std::min(text.find_first_not_of("0123456789", start), text.size()) - start;
  const std::array<std::size_t, 3> lengths = {piece.size(), digits, 0};
  text.replace(start, lengths[below(lengths.size(), random)], piece);
}

void change(std::string& text, std::span<const std::string> inputs, Random& random) {
  switch (below(5, random)) {
    case 0:
      if (!text.empty()) text[below(text.size(), random)] ^= static_cast<char>(1 << below(8, random));
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

}  // namespace

std::string mutant(std::span<const std::string> inputs, Random& random) {
  std::string text = inputs[below(inputs.size(), random)];
  for (std::size_t changes = 1 + below(4, random); changes > 0; --changes) change(text, inputs, random);
  return text;
}

}  // namespace clpv::fuzz
