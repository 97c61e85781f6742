// SPDX-License-Identifier: MIT
// The paper's look-up tables on the device, and lobes that the propagation kernel computes from
// them. clpv check compares such lobes with the CPU reference; these tests cover the rest.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <numeric>
#include <random>
#include <vector>

#include "kernels/shared/sort.h"
#include "pipeline/inject/lookup_table.hpp"
#include "pipeline/inject/sort_by_cell.hpp"
#include "pipeline/steps/propagate.hpp"
#include "support/error.hpp"
#include "tests/support/error_of.hpp"
#include "tests/support/on_device.hpp"
#include "tests/support/run_program.hpp"

namespace clpv::lookup_table_test {

namespace {

using test::test_session;
using ::testing::HasSubstr;

TEST(LookupTable, RejectsImagesThatTheDeviceLacks) {
  Device without = choose_device();
  without.images = false;
  Session other(without);
  const auto basis = make_basis("srbf4");
  EXPECT_THAT(test::error_of(ExitCode::device,
                             [&] {
                               LookupTable(other, *basis, {.kind = LobeKind::rotate},
                                           TableStorage::image, TableUse::lobes);
                             }),
              HasSubstr("no images"));
}

/// Entries 0 .. size - 1 as a kernel reads them, which is the same one for tables of a size.
std::vector<float> entries(const LookupTable& table, const LobeOptions& options) {
  Session& session = test_session();
  const test::TemporaryFolder folder;
  folder.write("entries.cl",
               "#include \"basis/lobe.h\"\n"
               "__kernel void entries(__global float* out CLPV_AND_H) {\n"
               "  const int i = (int)get_global_id(0);\n"
               "  out[i] = table_entry(singular_table, i);\n}\n");
  const test::Variable kernels("CLPV_KERNEL_DIR", folder.path().string());
  const auto basis = make_basis("srbf8v2");
  ProgramSource source{"entries.cl", lobe_literals(*basis, options)};
  add_coefficient_literals(source.literals, basis->size(), "float");
  table.add_literals(source.literals);
  const auto size = static_cast<std::size_t>(options.table_size);
  Kernel kernel(session, source, "entries");
  const Buffer out = session.buffer(size * sizeof(float), "entries");
  table.add_to(kernel.set(out));
  kernel.launch(size, 1);
  return session.read<float>(out, size);
}

class EachStorage : public ::testing::TestWithParam<TableStorage> {};
INSTANTIATE_TEST_SUITE_P(LookupTable, EachStorage,
                         ::testing::Values(TableStorage::buffer, TableStorage::image),
                         [](const auto& info) {
                           return info.param == TableStorage::buffer ? "Buffer" : "Image";
                         });

// A new stage creates its table again. Memory freed by the tables of former stages must not be this
// table's. Tables of one size share their kernel, and lie where a former one did.
TEST_P(EachStorage, TablesKeepTheirEntriesWhileOthersAreFreed) {
  if (GetParam() == TableStorage::image && !test_session().device().images)
    GTEST_SKIP() << "the device has no images";
  const LobeOptions options{.kind = LobeKind::rotate, .table_size = 200};
  constexpr int kLambdas = 12;
  for (int round = 0; round < 3; ++round) {
    for (int i = 0; i < kLambdas; ++i) {
      const auto basis = make_basis("srbf8v2", 0.25 + 0.001 * i);
      const auto gone = std::make_unique<LookupTable>(test_session(), *basis, options, GetParam(),
                                                      TableUse::lobes);
      const std::vector<float> rubbish(static_cast<std::size_t>(options.table_size), 1e15f);
      const LookupTable table(test_session(), *basis, options, GetParam(), TableUse::lobes);
      test_session().upload(rubbish, "what takes a freed table's place");
      EXPECT_EQ(entries(table, options), gram_tables(*basis, options.table_size).values())
          << "round " << round << ", table " << i;
    }
  }
}

constexpr int kGrid = 5, kSteps = 4;

/// The sums after some steps, of two lamps in a corner of the grid.
std::vector<float> accumulated(const Basis& basis, const Transport& transport,
                               const PropagateOptions& options) {
  const VolumeShape shape{kGrid, basis.size(), 3};
  Volume injected(test_session(), shape, "injected"), sum(test_session(), shape, "sum");
  const std::size_t plane = kGrid * kGrid * kGrid;
  std::vector<float> light(plane * static_cast<std::size_t>(basis.size()) * 3, 0.0f);
  const std::vector<double> lobe = basis.clamped_cosine(glm::normalize(glm::dvec3(3, 2, 1)));
  for (std::size_t row = 0; row < 3 * lobe.size(); ++row) {
    light[row * plane + 31] = static_cast<float>(lobe[row % lobe.size()]);
    light[row * plane + 62] =
        0.5f * light[row * plane + 31] * static_cast<float>(row / lobe.size());
  }
  injected.write(test_session(), light);
  Propagator(test_session(), basis, transport, options).propagate({injected, nullptr, sum}, kSteps);
  return sum.read(test_session());
}

TEST(RunTimeLobes, OfUnevenLambdasGiveTheLightOfConstantOnes) {
  const auto basis = make_basis_from_centres("uneven", make_basis("srbf4")->centres(),
                                             std::vector<double>{0.2, 0.3, 0.3, 0.25});
  for (const LobeKind kind : {LobeKind::exact, LobeKind::rotate}) {
    const Transport transport =
        make_transport(TransportKind::sampled, *basis, {.kind = kind, .table_functions = true});
    const std::vector<float> constant = accumulated(*basis, transport, {.grid = kGrid}),
                             computed = accumulated(*basis, transport,
                                                    {.grid = kGrid, .lobe_time = LobeTime::kernel});
    const float largest = std::ranges::max(constant);
    for (std::size_t i = 0; i < constant.size(); ++i)
      ASSERT_NEAR(computed[i], constant[i], 1e-5 * double{largest}) << name_of(kind) << " " << i;
  }
}

}  // namespace

}  // namespace clpv::lookup_table_test

namespace clpv::sort_by_cell_test {

// The sort by cell against the standard library's stable sort: every texel that has a cell once,
// cell by cell, each cell's in their own order.

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
