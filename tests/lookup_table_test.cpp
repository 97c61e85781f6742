// SPDX-License-Identifier: MIT
// The paper's look-up tables on the device, and lobes that the propagation kernel computes from them. clpv check compares such
// lobes with the CPU reference; here is what it does not have.
#include "pipeline/lookup_table.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <vector>

#include "basis/kernel_text.hpp"
#include "codegen/linear_code.hpp"
#include "pipeline/propagate.hpp"
#include "tests/support/error_of.hpp"
#include "tests/support/on_device.hpp"
#include "tests/support/run_here.hpp"

namespace clpv::lookup_table_test {
namespace {

using test::test_session;
using ::testing::HasSubstr;

/// What a kernel reads along each direction; by the functions that stages are generated with.
std::vector<float> looked_up(const Basis& basis, const LobeOptions& lobes, TableStorage storage,
                             const std::vector<cl_float4>& directions) {
  const LookupTable table(test_session(), basis, lobes, storage, TableUse::functions);
  ProgramSource source{"coefficients.h", {}, {}};
  source.generated = table.macros() + coefficient_macros(basis.size()) +
                     table_basis_source(basis, lobes.table_size) +
                     "__kernel void look_up(__global const float4* directions, __global float* found"
                     " CLPV_AND_TABLE) {\n"
                     "  const float4 d = directions[get_global_id(0)];\n"
                     "  found[get_global_id(0)] = clpv_table_basis(d.x, d.y, d.z CLPV_PASS_TABLE).c1;\n}\n";
  Kernel kernel(test_session(), source, "look_up");
  const Buffer given = test_session().upload(directions, "directions");
  const Buffer found = test_session().buffer(directions.size() * sizeof(float), "found");
  table.add_to(kernel.set(given, found));
  kernel.launch(directions.size(), 1);
  return test_session().read<float>(found, directions.size());
}

TEST(LookupTable, HoldsTheFunctionOnTheDevice) {
  // The second centre, whose table stands behind the first one's, is +x.
  const auto basis = make_basis_from_centres("two", {{0, 1, 0}, {1, 0, 0}}, std::vector<double>{0.2, 0.3});
  const LobeOptions lobes{.table_size = 64, .table_functions = true};
  const ZonalTables tables = function_tables(*basis, lobes.table_size);
  std::vector<cl_float4> directions{{{1, 0, 0, 0}}, {{-1, 0, 0, 0}}};
  for (int i = 0; i < 62; ++i) {
    const double t = -1 + 2 * (i + 0.5) / 63;  // between entries
    directions.push_back({{static_cast<float>(t), static_cast<float>(std::sqrt(1 - t * t)), 0, 0}});
  }
  const std::vector<float> buffer = looked_up(*basis, lobes, TableStorage::buffer, directions);
  for (std::size_t i = 0; i < directions.size(); ++i)
    EXPECT_EQ(buffer[i], static_cast<float>(tables(1, directions[i].s[0]))) << i;
  if (!test_session().device().images) GTEST_SKIP() << "no images on this device";
  EXPECT_EQ(looked_up(*basis, lobes, TableStorage::image, directions), buffer);
}

TEST(LookupTable, IsNotThereWhereNothingIsLookedUp) {
  const auto sh = make_basis("sh2"), srbf = make_basis("srbf4");
  const LobeOptions both{.kind = LobeKind::rotate, .table_functions = true};
  for (const TableUse use : {TableUse::lobes, TableUse::functions}) {
    for (const LookupTable& table : {LookupTable(test_session(), *sh, both, TableStorage::image, use),
                                     LookupTable(test_session(), *srbf, {}, TableStorage::image, use)}) {
      EXPECT_FALSE(table.exists());
      EXPECT_EQ(table.macros(), LookupTable::no_macros());
    }
    EXPECT_TRUE(LookupTable(test_session(), *srbf, both, TableStorage::buffer, use).exists());
  }
}

TEST(LookupTable, RejectsImagesThatTheDeviceHasNot) {
  Device without = choose_device();
  without.images = false;
  Session other(without);
  const auto basis = make_basis("srbf4");
  EXPECT_THAT(test::error_of(ExitCode::device,
                             [&] {
                               LookupTable(other, *basis, {.kind = LobeKind::rotate}, TableStorage::image,
                                           TableUse::lobes);
                             }),
              HasSubstr("no images"));
}

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
    light[row * plane + 62] = 0.5f * light[row * plane + 31] * static_cast<float>(row / lobe.size());
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

TEST(RunTimeLobes, AreRejectedWhereNoStepMakesAny) {
  const auto basis = make_basis("sh2");
  EXPECT_THAT(test::error_of(ExitCode::usage,
                             [&] {
                               Propagator(test_session(), *basis,
                                          make_transport(TransportKind::sampled, *basis),
                                          {.grid = 3, .state = State::fluxes, .lobe_time = LobeTime::kernel});
                             }),
              HasSubstr("state fluxes"));
}

// The paper's lobes and tables from end to end, and a set of a user's own.
TEST(RunTimeLobes, AreThereForUsers) {
  const test::TemporaryFolder folder;
  const std::string file =
      folder.write("mine.json", R"({"centres": [[1, 1, 1], [-1, -1, 1], [-1, 1, -1], [1, -1, -1]]})")
          .string();
  const auto run = [&](const std::string& given) {
    const test::Outcome outcome = test::run_here(
        "propagate --grid 5 --iterations 2 --at 2,2,2 --normal 1,2,3 --lobe rotate --evaluate table "
        "--table-size 99 " +
        given);
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
    return nlohmann::json::parse(outcome.out);
  };
  const auto last = [](const nlohmann::json& json) {
    return json["steps"].back()["travelling"][0].get<double>();
  };
  const nlohmann::json host = run("--centres " + file), kernel = run("--lobe-time kernel --centres " + file);
  EXPECT_NEAR(last(kernel), last(host), 1e-5 * last(host));
  EXPECT_EQ(kernel["options"]["lobe-time"], "kernel");
  EXPECT_EQ(kernel["options"]["table-size"], 99);
}

}  // namespace
}  // namespace clpv::lookup_table_test
