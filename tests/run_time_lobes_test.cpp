// SPDX-License-Identifier: MIT
// Look-up tables on the device and lobes made in the propagation kernel: the same light, by buffer and by image; refusals.
#include "pipeline/run_time_lobes.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "basis/kernel_text.hpp"
#include "codegen/linear_code.hpp"
#include "options/render_options.hpp"
#include "pipeline/propagate.hpp"
#include "support/error.hpp"
#include "tests/support/on_device.hpp"
#include "tests/support/run_program.hpp"

namespace clpv::run_time_lobes_test {
namespace {

using test::test_session;
using ::testing::HasSubstr;

// What a kernel reads at each height; by the functions that stages are generated with.
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
    EXPECT_FALSE(LookupTable(test_session(), *sh, both, TableStorage::image, use).exists());
    EXPECT_FALSE(LookupTable(test_session(), *srbf, {}, TableStorage::image, use).exists());
    EXPECT_TRUE(LookupTable(test_session(), *srbf, both, TableStorage::buffer, use).exists());
  }
}

TEST(LookupTable, RefusesImagesThatTheDeviceHasNot) {
  Device without = choose_device();
  without.images = false;
  Session other(without);
  const auto basis = make_basis("srbf4");
  try {
    const LookupTable table(other, *basis, {.kind = LobeKind::rotate}, TableStorage::image, TableUse::lobes);
    ADD_FAILURE() << "made";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ExitCode::device);
    EXPECT_THAT(error.what(), HasSubstr("no images"));
  }
}

constexpr int kGrid = 5, kSteps = 4;

// Two lamps in a corner of the grid.
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

class RunTimeLobesOf : public ::testing::TestWithParam<std::string> {};
INSTANTIATE_TEST_SUITE_P(Names, RunTimeLobesOf, ::testing::Values("sh2", "srbf4", "srbf8v2", "uneven"),
                         [](const auto& info) { return info.param; });

TEST_P(RunTimeLobesOf, GiveTheLightOfConstantOnes) {
  const auto basis = GetParam() != "uneven"
                         ? make_basis(GetParam())
                         : make_basis_from_centres("uneven", make_basis("srbf4")->centres(),
                                                   std::vector<double>{0.2, 0.3, 0.3, 0.25});
  for (const LobeKind kind : {LobeKind::exact, LobeKind::rotate}) {
    for (const TransportKind transported : {TransportKind::sampled, TransportKind::exact}) {
      for (const bool table : {false, true}) {
        const Transport transport =
            make_transport(transported, *basis, {.kind = kind, .table_functions = table});
        const std::vector<float> constant = accumulated(*basis, transport, {.grid = kGrid});
        const std::vector<float> made =
            accumulated(*basis, transport, {.grid = kGrid, .lobe_time = LobeTime::kernel});
        double largest = 0;
        for (const float value : constant) largest = std::max(largest, std::abs(static_cast<double>(value)));
        for (std::size_t i = 0; i < constant.size(); ++i)
          ASSERT_NEAR(made[i], constant[i], 1e-5 * largest)
              << name_of(transported) << " " << table << " " << i;
      }
    }
  }
}

TEST(RunTimeLobes, DoNotDependOnWhatHoldsTheTable) {
  if (!test_session().device().images) GTEST_SKIP() << "no images on this device";
  const auto basis = make_basis("srbf8v2");
  const Transport rotated = make_transport(TransportKind::sampled, *basis, {.kind = LobeKind::rotate}),
                  exact = make_transport(TransportKind::sampled, *basis);
  const PropagateOptions buffer{.grid = kGrid, .lobe_time = LobeTime::kernel};
  const PropagateOptions image{.grid = kGrid, .lobe_time = LobeTime::kernel, .table = TableStorage::image};
  EXPECT_EQ(accumulated(*basis, rotated, buffer), accumulated(*basis, rotated, image));
  EXPECT_NE(accumulated(*basis, rotated, buffer), accumulated(*basis, exact, buffer));
}

TEST(RunTimeLobes, AreRefusedWhereNoStepMakesAny) {
  const auto basis = make_basis("sh2");
  try {
    Propagator(test_session(), *basis, make_transport(TransportKind::sampled, *basis),
               {.grid = 3, .state = State::fluxes, .lobe_time = LobeTime::kernel});
    ADD_FAILURE() << "taken";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ExitCode::usage);
    EXPECT_THAT(error.what(), HasSubstr("state fluxes"));
  }
}

// The paper's lobes and tables from end to end, and a set of a user's own.
TEST(RunTimeLobes, AreThereForUsers) {
  const test::TemporaryFolder folder;
  const std::string program = CLPV_PROGRAM, file = (folder.path() / "mine.json").string();
  std::ofstream(file) << R"({"centres": [[1, 1, 1], [-1, -1, 1], [-1, 1, -1], [1, -1, -1]]})";
  const auto options = [&](const std::string& given) {
    const test::Outcome outcome =
        test::run(program + " propagate --grid 5 --iterations 2 --at 2,2,2 --normal 1,2,3 " + given);
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
    return outcome.exit_code == 0 ? nlohmann::json::parse(outcome.out) : nlohmann::json();
  };
  const auto last = [](const nlohmann::json& json) {
    return json["steps"].back()["travelling"][0].get<double>();
  };
  const std::string rotate = "--basis srbf8v1 --lobe rotate --evaluate table --table-size 99 ";
  const nlohmann::json host = options(rotate), kernel = options(rotate + "--lobe-time kernel");
  EXPECT_NEAR(last(kernel), last(host), 1e-5 * last(host));
  EXPECT_EQ(kernel["options"]["lobe-time"], "kernel");
  EXPECT_EQ(kernel["options"]["table-size"], 99);
  EXPECT_GT(std::abs(last(options("--basis srbf8v1")) - last(host)), 1e-4);
  EXPECT_GT(last(options("--centres " + file)), 0);

  const std::string scene = " render " CLPV_SOURCE_DIR
                            "/scenes/cornell.json --width 16 --height 9 --grid 8 -o " +
                            (folder.path() / "a.exr").string();
  const test::Outcome render = test::run(
      program + scene + " --transport sampled --lobe rotate --lobe-time kernel --evaluate table --centres " +
      file + " --stats " + (folder.path() / "a.json").string());
  ASSERT_EQ(render.exit_code, 0) << render.err;
  const auto stats = nlohmann::json::parse(test::read_file(folder.path() / "a.json")).at("options");
  EXPECT_EQ(stats["basis"], "mine");
  EXPECT_EQ(stats["lobe-time"], "kernel");
  EXPECT_EQ(test::run(program + scene + " --basis sh2 --centres " + file).exit_code, 2);
  EXPECT_EQ(test::run(program + scene + " --table-size 1").exit_code, 2);
}

}  // namespace
}  // namespace clpv::run_time_lobes_test
