// SPDX-License-Identifier: MIT
// A user's own SRBF set from a JSON file; every fault is told by its JSON pointer.
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

constexpr std::uintmax_t kMostBytes = 1 << 20;

glm::dvec3 unit_vector(const json& value, const std::string& path, std::size_t index) {
  const auto reject = [&](const std::string& place, const json& found) {
    return Error(ExitCode::bad_input, "{}: /centres/{}{} is {}; allowed: three finite numbers, not all 0",
                 path, index, place, quoted(found));
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
  return glm::normalize(v / largest);  // the square of a large number would overflow
}

std::vector<glm::dvec3> centres_of(const json& value, const std::string& path) {
  if (!value.is_array() || value.empty() || value.size() > kMostCentres) {
    throw Error(ExitCode::bad_input, "{}: /centres is {}; allowed: an array of 1 to {} directions [x, y, z]",
                path, quoted(value), kMostCentres);
  }
  std::vector<glm::dvec3> centres;
  for (const json& entry : value) {
    const glm::dvec3 centre = unit_vector(entry, path, centres.size());
    for (std::size_t j = 0; j < centres.size(); ++j) {
      if (glm::length(centres[j] - centre) < kLeastCentreDistance) {
        throw Error(ExitCode::bad_input,
                    "{}: /centres/{} is the direction of /centres/{}; allowed: {} radians apart", path,
                    centres.size(), j, kLeastCentreDistance);
      }
    }
    centres.push_back(centre);
  }
  return centres;
}

double lambda_of(const json& value, const std::string& path, const std::string& place) {
  const double lambda = value.is_number() ? value.get<double>() : 0;
  if (lambda > 0 && lambda < 1) return lambda;
  throw Error(ExitCode::bad_input, "{}: {} is {}; allowed: a number between 0 and 1, both excluded", path,
              place, quoted(value));
}

// One for each of so many centres.
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
  const json& given = file["name"];
  if (!given.is_string() || given.get_ref<const std::string&>().empty()) {
    throw Error(ExitCode::bad_input, "{}: /name is {}; allowed: a text that is not empty", path,
                quoted(given));
  }
  return given.get<std::string>();
}

}  // namespace

std::unique_ptr<Basis> load_basis(const std::string& path, double lambda) {
  const json file = read_json(path, kMostBytes);
  if (!file.is_object()) {
    throw Error(ExitCode::bad_input, "{}: holds {}; allowed: an object", path, quoted(file));
  }
  for (const auto& [key, value] : file.items()) {
    if (key != "name" && key != "lambda" && key != "centres") {
      throw Error(ExitCode::bad_input, "{}: unknown key {}; allowed: \"name\", \"lambda\", \"centres\"", path,
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
