// SPDX-License-Identifier: MIT
// Sets of SRBF centres: the search for them (its slopes against differences, its bounds, the same result for the same seed),
// a lambda for each centre, and files of centres.
#include "basis/centre_search.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>

#include "basis/basis.hpp"
#include "basis/rotated_lobe.hpp"
#include "quality/normal_weights.hpp"
#include "tests/support/error_of.hpp"
#include "tests/support/run_here.hpp"
#include "tests/support/sphere_quadrature.hpp"

namespace clpv::centre_search_test {
namespace {

using ::testing::HasSubstr;

CentreSet uneven_set() {
  return {even_directions(6), {.2, .3, .25, .4, .33, .21}};
}

LobeAims slanted_aims() {
  return {"slanted", {{glm::normalize(glm::dvec3(1, 2, -3)), .75}, {{0, 1, 0}, .25}}};
}

std::unique_ptr<Basis> basis_of(const CentreSet& set) {
  return make_basis_from_centres("set", set.centres, set.lambdas);
}

TEST(LambdaOfEachCentre, GramMatrixIsThatOfTheFunctions) {
  const auto basis = basis_of(uneven_set());
  EXPECT_EQ(basis->lambda(), 0);
  EXPECT_EQ(basis->lambda_text(), "0.2 to 0.4");
  for (int i = 0; i < basis->size(); ++i) {
    for (int j = 0; j < basis->size(); ++j) {
      const double expected = test::integral(test::sphere({0, 0, 1}, 40), [&](const glm::dvec3& w) {
        const std::vector<double> b = basis->evaluate(w);
        return b[static_cast<std::size_t>(i)] * b[static_cast<std::size_t>(j)];
      });
      EXPECT_NEAR(basis->gram()(i, j), expected, 1e-9) << i << ' ' << j;
    }
  }
}

TEST(LobeAims, MinimumErrorsAreThoseOfTheHarmonics) {
  // No 4 functions are better than sh2, no 9 than sh3, no 8 than sh2 with four of the next five.
  for (const auto& [functions, name] : {std::pair{4, "sh2"}, {9, "sh3"}}) {
    EXPECT_NEAR(minimum_error(functions), error_over(*make_basis(name), all_directions()), 1e-9);
  }
  EXPECT_NEAR(minimum_error(8), std::sqrt(1.0 / 8 - 4 * 3.0 / 128), 1e-12);
  EXPECT_NEAR(minimum_error(0), 1, 1e-12);
  for (const char* name : {"srbf4", "srbf6", "srbf8v1", "srbf8v2", "srbf8v3", "srbf14", "bins24"}) {
    const auto basis = make_basis(name);
    EXPECT_GT(error_over(*basis, all_directions()), minimum_error(basis->size())) << name;
  }
}

// error_over() sums over 2000 directions what the objective integrates: an error of some millionths.
constexpr double kSpiral = 1e-5;

class Objective : public ::testing::TestWithParam<int> {
 protected:
  const LobeAims aims_ = GetParam() == 0 ? all_directions() : slanted_aims();
  const CentreObjective objective_{aims_};
};
INSTANTIATE_TEST_SUITE_P(Aims, Objective, ::testing::Values(0, 1));

TEST_P(Objective, IsTheErrorOfTheBasis) {
  const double error = error_over(*basis_of(uneven_set()), aims_);
  EXPECT_NEAR(std::sqrt(objective_.square_error(uneven_set()).value), error, kSpiral);
}

TEST_P(Objective, BoundsTheConditionNumberFromAbove) {
  const double bound = std::exp(objective_.log_condition(uneven_set()).value),
               condition = basis_of(uneven_set())->condition();
  EXPECT_GT(bound, condition);
  EXPECT_LT(bound, 6 * condition);
}

TEST_P(Objective, SlopesAreThoseOfDifferences) {
  constexpr double kStep = 1e-6, kTolerance = 1e-7;
  const CentreSet set = uneven_set();
  for (const auto& value : {&CentreObjective::square_error, &CentreObjective::log_condition}) {
    const SetValue at = (objective_.*value)(set);
    const auto difference = [&](auto move) {
      CentreSet more = set, less = set;
      move(more, kStep), move(less, -kStep);
      return ((objective_.*value)(more).value - (objective_.*value)(less).value) / (2 * kStep);
    };
    for (std::size_t i = 0; i < set.centres.size(); ++i) {
      const glm::dvec3 across = test::across(set.centres[i]).first;
      const double by_lambda = difference([&](CentreSet& s, double step) { s.lambdas[i] += step; });
      const double by_centre = difference(
          [&](CentreSet& s, double step) { s.centres[i] = glm::normalize(s.centres[i] + step * across); });
      EXPECT_NEAR(at.by_lambda[i], by_lambda, kTolerance) << i;
      EXPECT_NEAR(glm::dot(at.by_centre[i], across), by_centre, kTolerance) << i;
    }
  }
}

CentreSearch quick(int centres) {
  CentreSearch search;
  search.centres = centres, search.starts = 6;
  return search;
}

TEST(SearchCentres, FindsTheSameSetForTheSameSeed) {
  CentreSearch search = quick(8);
  search.lambdas = SearchedLambdas::each;
  const CentreSearchResult one = search_centres(search), again = search_centres(search);
  EXPECT_EQ(one.set.centres, again.set.centres);
  EXPECT_EQ(one.set.lambdas, again.set.lambdas);
  search.seed = 2;
  EXPECT_NE(search_centres(search).set.centres, one.set.centres);
}

TEST(SearchCentres, IsBetterThanTheNamedSetsAndWithinTheBound) {
  const CentreSearchResult found = search_centres(quick(8));
  const auto basis = basis_of(found.set);
  EXPECT_NEAR(found.error, error_over(*basis, all_directions()), kSpiral);
  EXPECT_LE(basis->condition(), 2e4 * (1 + 1e-5));
  EXPECT_GT(found.error, minimum_error(8));
  EXPECT_LT(found.error, 0.19) << "srbf8v1 and srbf8v2 have 0.233";
  CentreSearch axes = quick(6);
  axes.aims = propagation_axes(), axes.lambdas = SearchedLambdas::none;
  EXPECT_NEAR(search_centres(axes).error, error_over(*make_basis("srbf6"), axes.aims), 1e-4)
      << "at lambda 0.25 no six centres hold the axes better than the axes themselves";
}

TEST(SearchCentres, SaysWhenNoSetIsWithinTheBounds) {
  CentreSearch search = quick(20);
  search.lambdas = SearchedLambdas::none, search.lambda = 0.05;
  EXPECT_THAT(test::error_of(ExitCode::usage, [&] { search_centres(search); }),
              ::testing::AllOf(HasSubstr("none of 6 starts"), HasSubstr("at most 2e+04")));
}

TEST(SearchCentres, RejectsWithTheBound) {
  const auto rejected = [](auto change, const char* word) {
    CentreSearch search = quick(4);
    change(search);
    EXPECT_THAT(test::error_of(ExitCode::usage, [&] { search_centres(search); }), HasSubstr(word));
  };
  rejected([](CentreSearch& s) { s.centres = 65; }, "--search: found 65, allowed: 1 to 64");
  rejected([](CentreSearch& s) { s.centres = 0; }, "--search: found 0");
  rejected([](CentreSearch& s) { s.lambda = 1; }, "lambda: found 1");
  rejected([](CentreSearch& s) { s.max_condition = 1e8; }, "1e+07");
}

TEST(SearchCentres, WritesAFileThatIsABasis) {
  const test::TemporaryFolder folder;
  const std::string file = (folder.path() / "mine.json").string();
  const test::Outcome outcome =
      test::run_here("basis --search 5 --starts 4 --lambdas each --format json -o " + file);
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  const auto json = nlohmann::json::parse(outcome.out);
  EXPECT_EQ(json.at("search").at("valid"), 4);
  const auto basis = load_basis(file);
  EXPECT_EQ(basis->name(), "mine");
  EXPECT_EQ(json.at("bases")[0].at("lambdas"), basis->lambdas());
  EXPECT_NEAR(error_over(*basis, all_directions()), json.at("search").at("error").get<double>(), kSpiral);
}

// From a scene's own normals to a set: a floor under a lamp has one normal.
TEST(SearchCentres, TakesAScenesNormals) {
  const test::TemporaryFolder folder;
  const std::string weights = (folder.path() / "normals.json").string();
  const test::Outcome render = test::run_here(" render " CLPV_SOURCE_DIR
                                              "/scenes/cornell.json --width 16 --height 9 --grid 8 "
                                              "--rsm-size 32 --dump-normals " +
                                              weights + " -o " + (folder.path() / "a.exr").string());
  ASSERT_EQ(render.exit_code, 0) << render.err;
  const LobeAims aims = load_aims(weights);
  double upwards = 0, all = 0;
  for (const WeightedDirection& aim : aims.directions) {
    all += aim.weight;
    upwards += aim.direction.y > 0.99 ? aim.weight : 0;
  }
  EXPECT_NEAR(all, 1, 1e-12);
  EXPECT_GT(upwards, 0.2) << "the floor";
  EXPECT_LT(aims.directions.size(), 97u);
  const test::Outcome search = test::run_here("basis --search 4 --starts 2 --weights " + weights);
  EXPECT_EQ(search.exit_code, 0) << search.err;
  EXPECT_EQ(test::run_here("basis --search 4 --over axes --weights " + weights).exit_code, 2);
  EXPECT_EQ(test::run_here("basis --seed 4").exit_code, 2);
}

class CentresFile : public ::testing::Test {
 protected:
  std::string file(const std::string& text) {
    const std::string path = (folder_.path() / "mine.json").string();
    std::ofstream(path) << text;
    return path;
  }
  void expect_rejected(const std::string& path, const std::string& word) {
    expect_rejected(path, word, [&] { load_basis(path); });
  }
  template <typename Load>
  void expect_rejected(const std::string& path, const std::string& word, Load load) {
    EXPECT_THAT(test::error_of(ExitCode::bad_input, load),
                ::testing::AllOf(::testing::HasSubstr(path), ::testing::HasSubstr(word)));
  }
  test::TemporaryFolder folder_;
};

const char* const kAxesFile = R"({"name": "axes", "centres":
    [[2, 0, 0], [-1e200, 0, 0], [0, 1, 0], [0, -3, 0], [0, 0, 1e-200], [0, 0, -1]]})";

TEST_F(CentresFile, MakesTheBasis) {
  const auto basis = load_basis(file(kAxesFile), 0.3);
  const auto named = make_basis("srbf6", 0.3);
  EXPECT_EQ(basis->name(), "axes");
  EXPECT_EQ(basis->centres(), named->centres());
  EXPECT_EQ(basis->condition(), named->condition());
  EXPECT_EQ(load_basis(file(R"({"centres": [[0, 0, 1]]})"))->name(), "mine");
}

TEST_F(CentresFile, RejectsWithThePlace) {
  const std::pair<std::string, std::string> bad[] = {
      {"{", "invalid JSON"},
      {"[1]", "object"},
      {"{}", "/centres is missing"},
      {R"({"centres": []})", "1 to 64"},
      {R"({"centres": 7})", "is 7"},
      {R"({"centres": [[0, 0, 1], [1, 2]]})", "/centres/1"},
      {R"({"centres": [[0, 0, 0]]})", "/centres/0"},
      {R"({"centres": [[0, 0, "1"]]})", "/centres/0/2"},
      {R"({"centres": [[0, 0, 1e999]]})", "invalid JSON"},
      {R"({"centres": [[0, 0, 1], [0, 0, 5]]})", "/centres/1"},
      {R"({"centres": [[0, 0, 1]], "lambda": 1})",
       "/lambda is 1; allowed: a number greater than 0 and less than 1"},
      {R"({"centres": [[0, 0, 1]], "lambda": "wide"})", "/lambda is \"wide\""},
      {R"({"centres": [[0, 0, 1], [1, 0, 0]], "lambda": [0.2, 0]})", "/lambda/1 is 0"},
      {R"({"centres": [[0, 0, 1], [1, 0, 0]], "lambda": [0.2]})",
       "/lambda is an array of 1; allowed: a number, or 2"},
      {R"({"centres": [[0, 0, 1], [0.01, 0, 1]], "lambda": 0.01})", "condition number"},
      {R"({"centres": [[0, 0, 1]], "lambdas": 0.2})", "lambdas"},
      {R"({"centres": [[0, 0, 1]], "name": 3})", "/name"},
      {std::string(100000, '['), "nested more than"},
      {std::string(2 << 20, ' '), "bytes"},
  };
  for (const auto& [text, word] : bad) expect_rejected(file(text), word);
  std::string many = "[[0,0,1]";
  for (int i = 1; i < 65; ++i) many += ",[" + std::to_string(i) + ",1,0]";
  expect_rejected(file("{\"centres\": " + many + "]}"), "array of 65");
  expect_rejected((folder_.path() / "none.json").string(), "no file");
  expect_rejected(folder_.path().string(), "a folder");
}

TEST_F(CentresFile, WeightsAreRejectedWithThePlaceToo) {
  for (const auto& [text, word] : {std::pair{"{", "invalid JSON"},
                                   {"[]", "/weights"},
                                   {R"({"weights": []})", "1 to 10000"},
                                   {R"({"weights": [[0, 0, 1, 1], [0, 0, 1]]})", "/weights/1"},
                                   {R"({"weights": [[0, 0, 0, 1]]})", "/weights/0"},
                                   {R"({"weights": [[0, 0, 1, -1]]})", "/weights/0"}}) {
    const std::string path = file(text);
    expect_rejected(path, word, [&] { load_aims(path); });
  }
}

TEST_F(CentresFile, IsDescribedByTheProgram) {
  const test::Outcome good = test::run_here("basis --format json --lambda 0.3 --centres " + file(kAxesFile));
  ASSERT_EQ(good.exit_code, 0) << good.err;
  const auto json = nlohmann::json::parse(good.out);
  EXPECT_EQ(json.at("schema"), 1);
  EXPECT_EQ(json.at("bases").size(), 1u);
  EXPECT_EQ(json.at("bases")[0].at("name"), "axes");
  EXPECT_EQ(test::run_here("basis --centres " + file("{")).exit_code, 3);
  EXPECT_EQ(test::run_here("basis sh2 --centres " + file(kAxesFile)).exit_code, 2);
  EXPECT_EQ(test::run_here("basis --lambda 0.001 --centres " + file(kAxesFile)).exit_code, 2);
}

}  // namespace
}  // namespace clpv::centre_search_test
