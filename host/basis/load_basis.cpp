// SPDX-License-Identifier: MIT
// Loads a user's SRBF set from a JSON file. Errors name the JSON pointer of the invalid value.
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "basis/basis.hpp"
#include "support/error.hpp"
#include "support/json_schema.hpp"

namespace clpv {
namespace {

using nlohmann::json;

glm::dvec3 unit_vector(const json& value, const std::string& path, std::size_t index) {
  const auto reject = [&](const std::string& place, const json& found) {
    return Error(ExitCode::bad_input,
                 "{}: /centres/{}{} is {}; allowed: three finite numbers, not all 0", path, index,
                 place, quoted(found));
  };
  if (!value.is_array() || value.size() != 3) throw reject("", value);
  glm::dvec3 v;
  double largest = 0;
  for (int i = 0; i < 3; ++i) {
    const json& number = value[i];
    if (!number.is_number()) throw reject(fmt::format("/{}", i), number);
    v[i] = number.get<double>();
    largest = std::max(largest, std::abs(v[i]));
  }
  if (!std::isfinite(largest) || largest == 0) throw reject("", value);
  return glm::normalize(v / largest);  // scaled first: squares of large numbers overflow
}

std::vector<glm::dvec3> centres_of(const json& value, const std::string& path) {
  if (!value.is_array() || value.empty() || value.size() > kMaxCentres) {
    throw Error(ExitCode::bad_input,
                "{}: /centres is {}; allowed: an array of 1 to {} directions [x, y, z]", path,
                quoted(value), kMaxCentres);
  }
  std::vector<glm::dvec3> centres;
  for (const json& entry : value) {
    const glm::dvec3 centre = unit_vector(entry, path, centres.size());
    for (std::size_t j = 0; j < centres.size(); ++j) {
      if (glm::length(centres[j] - centre) < kMinCentreDistance) {
        throw Error(ExitCode::bad_input,
                    "{}: /centres/{} has the direction of /centres/{}; allowed: {} rad apart", path,
                    centres.size(), j, kMinCentreDistance);
      }
    }
    centres.push_back(centre);
  }
  return centres;
}

double lambda_of(const json& value, const std::string& path, const std::string& place) {
  const double lambda = value.is_number() ? value.get<double>() : 0;
  if (lambda > 0 && lambda < 1) return lambda;
  throw Error(ExitCode::bad_input, "{}: {} is {}; allowed: a number greater than 0 and less than 1",
              path, place, quoted(value));
}

// One lambda for each of `count` centres.
std::vector<double> lambdas_of(const json& value, const std::string& path, std::size_t count) {
  if (!value.is_array()) return std::vector<double>(count, lambda_of(value, path, "/lambda"));
  if (value.size() != count) {
    throw Error(ExitCode::bad_input,
                "{}: /lambda is {}; allowed: a number, or {} numbers, one for each centre", path,
                quoted(value), count);
  }
  std::vector<double> lambdas;
  for (const json& entry : value)
    lambdas.push_back(lambda_of(entry, path, fmt::format("/lambda/{}", lambdas.size())));
  return lambdas;
}

std::string name_of(const json& file, const std::string& path) {
  if (!file.contains("name")) return std::filesystem::path(path).stem().string();
  const json& name = file["name"];
  if (!name.is_string() || name.get_ref<const std::string&>().empty()) {
    throw Error(ExitCode::bad_input, "{}: /name is {}; allowed: a string that is not empty", path,
                quoted(name));
  }
  return name.get<std::string>();
}

}  // namespace

std::unique_ptr<Basis> load_basis(const std::string& path, double lambda) {
  const json file = read_json(path, kCentresBytes);
  if (!file.is_object()) {
    throw Error(ExitCode::bad_input, "{}: found {}; allowed: an object", path, quoted(file));
  }
  for (const auto& [key, value] : file.items()) {
    if (key != "name" && key != "lambda" && key != "centres") {
      throw Error(ExitCode::bad_input,
                  "{}: unknown key {}; allowed: \"name\", \"lambda\", \"centres\"", path,
                  quoted(json(key)));
    }
  }
  if (!file.contains("centres")) throw Error(ExitCode::bad_input, "{}: /centres is missing", path);
  const std::string name = name_of(file, path);
  const std::vector<glm::dvec3> centres = centres_of(file["centres"], path);
  if (!file.contains("lambda")) return make_basis_from_centres(name, centres, lambda);
  const std::vector<double> lambdas = lambdas_of(file["lambda"], path, centres.size());
  try {
    return make_basis_from_centres(name, centres, lambdas);
  } catch (const Error& error) {
    throw Error(ExitCode::bad_input, "{}: {}", path, error.what());
  }
}

}  // namespace clpv
