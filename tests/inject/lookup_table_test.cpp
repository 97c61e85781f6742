// SPDX-License-Identifier: MIT
// The paper's look-up tables on the device, and lobes that the propagation kernel computes from
// them. clpv check compares such lobes with the CPU reference; these tests cover the rest.
#include "pipeline/inject/lookup_table.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <vector>

#include "pipeline/inject/lobe_literals.hpp"
#include "pipeline/steps/propagate.hpp"
#include "tests/support/error_of.hpp"
#include "tests/support/on_device.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/support/variable.hpp"

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
