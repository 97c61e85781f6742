// SPDX-License-Identifier: MIT
// Loads a user's SRBF set from a JSON file. Errors name the JSON pointer of the invalid value.
#include <filesystem>
#include <limits>
#include <nlohmann/json.hpp>

#include "basis/basis.hpp"
#include "support/error.hpp"
#include "support/json_schema.hpp"

namespace clpv {
namespace {

using nlohmann::json;

std::vector<Rule> rules_of(const json& file) {
  constexpr double kMax = std::numeric_limits<double>::max();
  std::vector<Rule> rules = {rule::object(""), rule::text("/name"),
                             rule::list("/centres", 1, kMaxCentres).must(),
                             rule::vector("/centres/*", 3, -kMax, kMax)};
  if (!file.is_object() || !file.contains("lambda") || !file["lambda"].is_array()) {
    rules.push_back(rule::number("/lambda", 0, 1));
  } else {
    const std::size_t count = file.contains("centres") ? file["centres"].size() : 0;
    rules.push_back(rule::list("/lambda", count, count));  // one for each centre
    rules.push_back(rule::number("/lambda/*", 0, 1));
  }
  return rules;
}

glm::dvec3 unit_vector(const json& value, const std::string& path, std::size_t index) {
  const glm::dvec3 v(value[0].get<double>(), value[1].get<double>(), value[2].get<double>()),
      size = glm::abs(v);
  const double largest = std::max({size.x, size.y, size.z});
  if (largest == 0)
    reject(path, fmt::format("/centres/{}", index), "a vector of no length", "a direction");
  return glm::normalize(v / largest);  // scaled first: squares of large numbers overflow
}

}  // namespace

std::unique_ptr<Basis> load_basis(const std::string& path, double lambda) {
  const json file = read_json(path, kCentresBytes);
  const std::vector<Rule> rules = rules_of(file);
  check_rules(file, rules, path);
  check_no_other_keys(file, rules, path);
  std::vector<glm::dvec3> centres;
  for (const json& centre : file["centres"])
    centres.push_back(unit_vector(centre, path, centres.size()));
  std::vector<double> lambdas(centres.size(), lambda);
  if (file.contains("lambda") && file["lambda"].is_array()) {
    lambdas = file["lambda"].get<std::vector<double>>();
  } else if (file.contains("lambda")) {
    lambdas.assign(centres.size(), file["lambda"].get<double>());
  }
  try {
    return make_basis_from_centres(file.value("name", std::filesystem::path(path).stem().string()),
                                   centres, lambdas);
  } catch (const Error& error) {
    throw Error(ExitCode::bad_input, "{}: {}", path, error.what());
  }
}

}  // namespace clpv
