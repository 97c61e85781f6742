// SPDX-License-Identifier: MIT
// In which order, and in which pieces, work is handed out to ranks, so that none ends much later than the others.
#pragma once

#include <cstddef>
#include <vector>

namespace clpv {

/// Items that are handed out together, in this order.
using Piece = std::vector<std::size_t>;

/// Groups of items that are best done by one rank, one after the other, since what is made for the first of them serves the
/// others: longest first. Where there are fewer groups than ranks they are split into their items: what is made twice then
/// costs nobody's time.
/// `costs`: of items, in any one unit; none negative.
std::vector<Piece> longest_first(const std::vector<std::vector<std::size_t>>& groups,
                                 const std::vector<double>& costs, int ranks);

/// Items that cost alike and are best done in their order: runs of neighbours, each a part of what is left, so that they get
/// shorter, down to one item.
std::vector<Piece> shrinking_runs(const std::vector<std::size_t>& items, int ranks);

}  // namespace clpv
