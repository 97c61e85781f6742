// SPDX-License-Identifier: MIT
// Sets of SRBF centres: files of them, and a lambda for each centre.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>

#include "basis/basis.hpp"
#include "basis/lobe_quality.hpp"
#include "tests/support/error_of.hpp"
#include "tests/support/run_here.hpp"
#include "tests/support/sphere_quadrature.hpp"

namespace clpv::centres_file_test {
namespace {

using ::testing::HasSubstr;

TEST(LambdaOfEachCentre, GramMatrixIsThatOfTheFunctions) {
  const std::vector<double> lambdas{.2, .3, .25, .4, .33, .21};
  const auto basis = make_basis_from_centres("set", even_directions(6), lambdas);
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

class CentresFile : public ::testing::Test {
 protected:
  std::string file(const std::string& text) {
    const std::string path = (folder_.path() / "mine.json").string();
    std::ofstream(path) << text;
    return path;
  }
  void expect_rejected(const std::string& path, const std::string& word) {
    EXPECT_THAT(test::error_of(ExitCode::bad_input, [&] { load_basis(path); }),
                ::testing::AllOf(HasSubstr(path), HasSubstr(word)));
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

TEST_F(CentresFile, IsDescribedByTheProgram) {
  const test::Outcome good =
      test::must_run_here("basis --format json --lambda 0.3 --centres " + file(kAxesFile));
  const auto json = nlohmann::json::parse(good.out);
  EXPECT_EQ(json.at("schema"), 1);
  EXPECT_EQ(json.at("bases").size(), 1u);
  EXPECT_EQ(json.at("bases")[0].at("name"), "axes");
  EXPECT_EQ(test::run_here("basis --centres " + file("{")).exit_code, 3);
  EXPECT_EQ(test::run_here("basis sh2 --centres " + file(kAxesFile)).exit_code, 2);
  EXPECT_EQ(test::run_here("basis --lambda 0.001 --centres " + file(kAxesFile)).exit_code, 2);
}

}  // namespace
}  // namespace clpv::centres_file_test
