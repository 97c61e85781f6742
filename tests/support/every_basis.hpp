// SPDX-License-Identifier: MIT
// The fixture of tests that every basis has to pass; each file derives and instantiates its own.
#pragma once

#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <vector>

#include "basis/basis.hpp"

namespace clpv::test {

/// All but the direction bins: these jump, which quadrature over the whole sphere does not integrate, and have up to 96
/// functions, which take long to compile. rotated_lobe_test.cpp and the check of propagation have them.
inline std::vector<std::string> smooth_bases() {
  std::vector<std::string> names = basis_names();
  std::erase_if(names, [](const std::string& name) { return name.starts_with("bins"); });
  return names;
}

class EveryBasis : public ::testing::TestWithParam<std::string> {
 protected:
  const std::unique_ptr<Basis> basis_ = make_basis(GetParam());
};

}  // namespace clpv::test
