// SPDX-License-Identifier: MIT
// The sort by cell against the standard library's stable sort: every texel that has a cell once,
// cell by cell, each cell's in their own order.
#include "pipeline/inject/sort_by_cell.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <numeric>
#include <random>
#include <vector>

#include "kernels/shared/sort.h"
#include "support/error.hpp"
#include "tests/support/on_device.hpp"

namespace clpv::sort_by_cell_test {
namespace {

using test::test_session;
using Keys = std::vector<cl_uint>;
using Entry = std::array<cl_uint, 2>;  // cell, texel

std::vector<Entry> sorted_here(const Keys& keys) {
  std::vector<Entry> entries;
  for (cl_uint texel = 0; texel < keys.size(); ++texel) {
    if (keys[texel] != CLPV_NO_CELL) entries.push_back({keys[texel], texel});
  }
  std::ranges::stable_sort(entries, {}, [](const Entry& entry) { return entry[0]; });
  return entries;
}

std::vector<Entry> sorted_there(CellSorter& sorter, const Keys& keys, std::size_t cells) {
  sorter.reserve(keys.size());
  test_session().write(sorter.keys(), keys);
  sorter.sort(keys.size(), cells);
  const cl_uint count = test_session().read<cl_uint>(sorter.count(), 1)[0];
  EXPECT_LE(count, keys.size());
  return test_session().read<Entry>(sorter.sorted(), std::min<std::size_t>(count, keys.size()));
}

void expect_sorted(const Keys& keys, std::size_t cells) {
  CellSorter sorter(test_session());
  EXPECT_EQ(sorted_there(sorter, keys, cells), sorted_here(keys))
      << keys.size() << " texels, " << cells;
}

/// Runs of up to `longest` neighbours in one cell, as surfaces have; one texel in eight has no
/// cell.
Keys in_runs(std::size_t texels, cl_uint cells, unsigned longest, unsigned seed = 1) {
  std::mt19937 random(seed);
  Keys keys;
  while (keys.size() < texels) {
    const cl_uint key = random() % 8 == 0 ? CLPV_NO_CELL : static_cast<cl_uint>(random()) % cells;
    keys.insert(keys.end(), 1 + random() % longest, key);
  }
  keys.resize(texels);
  return keys;
}

TEST(SortByCell, CellsOfNoOneAndManyTexels) {
  expect_sorted(Keys(1000, CLPV_NO_CELL), 512);
  expect_sorted({32767}, 32768);
  for (const std::size_t texels : {15u, 16u, 17u, 255u, 257u, 5000u})
    expect_sorted(Keys(texels, 4912), 4913);
  Keys each_its_own(4096);
  std::iota(each_its_own.rbegin(), each_its_own.rend(), 0);
  expect_sorted(each_its_own, 4096);
  // Odd and even numbers of bits, powers of two and their neighbours.
  for (const cl_uint cells : {2u, 3u, 64u, 125u, 729u, 32768u, 35937u, 2146689u}) {
    expect_sorted(in_runs(3000, cells, 1), cells);
    expect_sorted(in_runs(3000, cells, 70), cells);
    expect_sorted(in_runs(3000, std::min(cells, 5u), 20), cells);
  }
}

// More texels than 512 chunks of minimum length, so chunks grow; not a multiple of a run's length.
TEST(SortByCell, LargeSurfaces) {
  expect_sorted(in_runs(200'003, 4096, 40), 4096);
}

TEST(SortByCell, OneSorterTakesSurfacesOfAllSizes) {
  CellSorter sorter(test_session());
  for (const auto& [texels, cells] :
       {std::pair{100u, 64u}, {20'000u, 32768u}, {7u, 2u}, {3000u, 1u}, {20'000u, 35937u}}) {
    const Keys keys = in_runs(texels, cells, 30, texels);
    EXPECT_EQ(sorted_there(sorter, keys, cells), sorted_here(keys))
        << texels << " texels, " << cells;
  }
}

TEST(SortByCell, RejectsMoreTexelsThanRunsCanName) {
  CellSorter sorter(test_session());
  EXPECT_THROW(sorter.reserve((std::size_t{1} << 28) + 1), Error);
}

}  // namespace
}  // namespace clpv::sort_by_cell_test
