// SPDX-License-Identifier: MIT
// The paper's look-up tables on the device: what kernels read is what is in them, however many came and went before.
#include "pipeline/lookup_table.hpp"

#include <gtest/gtest.h>

#include <vector>

#include "tests/support/on_device.hpp"

namespace clpv::lookup_table_test {
namespace {

using test::test_session;

/// Entries 0 .. size - 1 as a kernel reads them.
std::vector<float> entries(const LookupTable& table, int size) {
  Session& session = test_session();
  // Of a file that is definitions alone, as a program is of some file.
  ProgramSource source{"shared/sort.h", {}, {}};
  source.generated = table.macros() +
                     "__kernel void entries(__global float* out CLPV_AND_TABLE) {\n"
                     "  const int i = (int)get_global_id(0);\n  out[i] = CLPV_TABLE_READ(table, i);\n}\n";
  Kernel kernel(session, source, "entries");
  const Buffer out = session.buffer(static_cast<std::size_t>(size) * sizeof(float), "entries");
  table.add_to(kernel.set(out));
  kernel.launch(static_cast<std::size_t>(size), 1);
  return session.read<float>(out, static_cast<std::size_t>(size));
}

class EachStorage : public ::testing::TestWithParam<TableStorage> {};
INSTANTIATE_TEST_SUITE_P(LookupTable, EachStorage,
                         ::testing::Values(TableStorage::buffer, TableStorage::image), [](const auto& info) {
                           return info.param == TableStorage::buffer ? "Buffer" : "Image";
                         });

// A stage makes its table anew; those of stages that are gone leave memory to others, and must not leave this one's.
TEST_P(EachStorage, TablesKeepTheirEntriesWhileOthersComeAndGo) {
  if (GetParam() == TableStorage::image && !test_session().device().images)
    GTEST_SKIP() << "the device has no images";
  const auto basis = make_basis("srbf8v2");
  constexpr int kSizes = 12;
  for (int round = 0; round < 3; ++round) {
    for (int i = 0; i < kSizes; ++i) {
      const LobeOptions options{.kind = LobeKind::rotate, .table_size = 200 + i};
      const auto gone =
          std::make_unique<LookupTable>(test_session(), *basis, options, GetParam(), TableUse::lobes);
      const std::vector<float> rubbish(static_cast<std::size_t>(options.table_size), 1e15f);
      const LookupTable table(test_session(), *basis, options, GetParam(), TableUse::lobes);
      test_session().upload(rubbish, "what takes a freed table's place");
      EXPECT_EQ(entries(table, options.table_size), gram_tables(*basis, options.table_size).values())
          << "round " << round << ", " << options.table_size << " entries";
    }
  }
}

TEST(LookupTable, NoneWhereNothingIsLookedUp) {
  const auto basis = make_basis("srbf8v2"), harmonics = make_basis("sh2");
  const LookupTable exact(test_session(), *basis, {}, TableStorage::buffer, TableUse::lobes);
  const LookupTable rotated(test_session(), *harmonics, {.kind = LobeKind::rotate}, TableStorage::buffer,
                            TableUse::lobes);
  for (const LookupTable* table : {&exact, &rotated}) {
    EXPECT_FALSE(table->exists());
    EXPECT_EQ(table->macros(), LookupTable::no_macros());
  }
}

}  // namespace
}  // namespace clpv::lookup_table_test
