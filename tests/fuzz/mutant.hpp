// SPDX-License-Identifier: MIT
// Inputs near those of a corpus, made blindly: for builds without libFuzzer, which would look at what they reach.
#pragma once

#include <random>
#include <span>
#include <string>

namespace clpv::fuzz {

/// One of the inputs, changed in one to four places: a bit turned, a byte or a number set to one at an edge, a span left out,
/// said twice, or put in from another input. `inputs` must not be empty.
std::string mutant(std::span<const std::string> inputs, std::mt19937_64& random);

}  // namespace clpv::fuzz
