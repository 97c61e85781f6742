// SPDX-License-Identifier: MIT
#include "pipeline/steps/stencil.hpp"

#include <algorithm>

namespace clpv {
namespace {

// Fills 16-wide vectors; wider groups do not help on a CPU.
constexpr std::size_t kWidestGroup = 64;

std::size_t items_per_row(int grid, int lanes) {
  return (grid + lanes - 1) / lanes;
}

}  // namespace

Stencil::Stencil(const Device& device, const StencilOptions& options) : options_(options) {
  if (options_.lanes == 0) options_.lanes = preferred_lanes(device, options.format);
  group_ = std::min(items_per_row(options.grid, options_.lanes), kWidestGroup);
}

Literals Stencil::literals() const {
  Literals literals;
  literals.integer("CLPV_GRID", options_.grid).integer("CLPV_LOCAL_X", group_);
  add_format_literals(literals, options_.format, options_.lanes);
  return literals;
}

void Stencil::launch(Kernel& kernel, int channels) const {
  const std::size_t n = options_.grid;
  kernel.launch({items_per_row(options_.grid, options_.lanes), n, n * static_cast<std::size_t>(channels)},
                {group_, 1, 1});
}

}  // namespace clpv
