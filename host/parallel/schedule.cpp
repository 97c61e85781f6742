// SPDX-License-Identifier: MIT
#include "parallel/schedule.hpp"

#include <algorithm>
#include <numeric>

namespace clpv {
namespace {

// Runs are so many times shorter than an even split of what is left: costs that differ by as much even out.
constexpr std::size_t kRunsLeft = 2;

}  // namespace

std::vector<Piece> longest_first(const std::vector<std::vector<std::size_t>>& groups,
                                 const std::vector<double>& costs, int ranks) {
  const auto cost_of = [&](const std::vector<std::size_t>& group) {
    return std::accumulate(group.begin(), group.end(), 0.0,
                           [&](double sum, std::size_t item) { return sum + costs[item]; });
  };
  std::vector<std::pair<double, std::size_t>> order;
  for (std::size_t g = 0; g < groups.size(); ++g) {
    if (!groups[g].empty()) order.emplace_back(cost_of(groups[g]), g);
  }
  const bool whole = order.size() >= static_cast<std::size_t>(ranks);
  std::ranges::stable_sort(order, [](const auto& a, const auto& b) { return a.first > b.first; });
  std::vector<Piece> pieces;
  for (const auto& [cost, g] : order) {
    if (whole) {
      pieces.push_back(groups[g]);
    } else {
      for (const std::size_t item : groups[g]) pieces.push_back({item});
    }
  }
  return pieces;
}

std::vector<Piece> shrinking_runs(const std::vector<std::size_t>& items, int ranks) {
  std::vector<Piece> pieces;
  const std::size_t part = kRunsLeft * static_cast<std::size_t>(ranks);
  for (std::size_t first = 0; first < items.size();) {
    const std::size_t count = ranks == 1 ? items.size() : (items.size() - first + part - 1) / part;
    pieces.emplace_back(items.begin() + static_cast<std::ptrdiff_t>(first),
                        items.begin() + static_cast<std::ptrdiff_t>(first + count));
    first += count;
  }
  return pieces;
}

}  // namespace clpv
