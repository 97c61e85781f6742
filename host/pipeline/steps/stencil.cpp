// SPDX-License-Identifier: MIT
#include "pipeline/steps/stencil.hpp"

#include <algorithm>

namespace clpv {
namespace {

// Fills 16-wide vectors; wider groups do not help on a CPU.
constexpr std::size_t kWidestGroup = 64;

}  // namespace

Stencil::Stencil(int grid, const VolumeFormat& format, int lanes)
    : grid_(grid), format_(format), lanes_(lanes), group_(std::min(row(), kWidestGroup)) {}

std::size_t Stencil::row() const {
  return (grid_ + lanes_ - 1) / lanes_;
}

Literals Stencil::literals() const {
  Literals literals;
  literals.integer("CLPV_LOCAL_X", group_);
  add_volume_literals(literals, grid_, format_, lanes_);
  return literals;
}

void Stencil::launch(Kernel& kernel, int channels) const {
  const std::size_t n = grid_;
  kernel.launch({row(), n, n * static_cast<std::size_t>(channels)}, {group_, 1, 1});
}

}  // namespace clpv
