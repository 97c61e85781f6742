// A user's own SRBF set from a JSON file; every fault is told by its JSON pointer.
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "basis/basis.hpp"
#include "support/error.hpp"

namespace clpv {
namespace {

using nlohmann::json;

constexpr std::size_t kMostCentres = 64;
constexpr std::uintmax_t kMostBytes = 1 << 20;
constexpr double kLeastAngle = 1e-3;  // radians between centres; nearer ones make A singular anyway

json read_json(const std::string& path) {
  std::error_code failed;
  const auto bytes = std::filesystem::file_size(path, failed);
  if (failed) throw Error(ExitCode::bad_input, "{}: cannot be read: {}", path, failed.message());
  if (bytes > kMostBytes) {
    throw Error(ExitCode::bad_input, "{}: {} bytes; a file of centres has at most {}", path, bytes,
                kMostBytes);
  }
  std::ifstream in(path, std::ios::binary);
  try {
    return json::parse(in);
  } catch (const json::exception& error) {
    throw Error(ExitCode::bad_input, "{}: not JSON: {}", path, error.what());
  }
}

// What a message quotes of a value: enough to recognise it.
std::string quoted(const json& value) {
  constexpr std::size_t kLength = 60;
  if (value.is_structured()) return fmt::format("an {} of {}", value.type_name(), value.size());
  const std::string text = value.dump(-1, ' ', true, json::error_handler_t::replace);
  return text.size() <= kLength ? text : text.substr(0, kLength) + "...";
}

glm::dvec3 unit_vector(const json& value, const std::string& path, std::size_t index) {
  const auto refuse = [&](const std::string& place, const json& found) {
    return Error(ExitCode::bad_input, "{}: /centres/{}{} is {}; allowed: three finite numbers, not all 0",
                 path, index, place, quoted(found));
  };
  if (!value.is_array() || value.size() != 3) throw refuse("", value);
  glm::dvec3 v;
  double largest = 0;
  for (int i = 0; i < 3; ++i) {
    const json& number = value[static_cast<std::size_t>(i)];
    if (!number.is_number()) throw refuse(fmt::format("/{}", i), number);
    v[i] = number.get<double>();
    largest = std::max(largest, std::abs(v[i]));
  }
  if (!std::isfinite(largest) || largest == 0) throw refuse("", value);
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
      if (glm::length(centres[j] - centre) < kLeastAngle) {
        throw Error(ExitCode::bad_input,
                    "{}: /centres/{} is the direction of /centres/{}; allowed: {} radians apart", path,
                    centres.size(), j, kLeastAngle);
      }
    }
    centres.push_back(centre);
  }
  return centres;
}

}  // namespace

std::unique_ptr<Basis> load_basis(const std::string& path, double lambda) {
  const json file = read_json(path);
  if (!file.is_object()) {
    throw Error(ExitCode::bad_input, "{}: holds {}; allowed: an object", path, quoted(file));
  }
  for (const auto& [key, value] : file.items()) {
    if (key != "name" && key != "centres") {
      throw Error(ExitCode::bad_input, "{}: unknown key {}; allowed: \"name\", \"centres\"", path,
                  quoted(json(key)));
    }
  }
  if (!file.contains("centres")) throw Error(ExitCode::bad_input, "{}: /centres is missing", path);
  std::string name = std::filesystem::path(path).stem().string();
  if (file.contains("name")) {
    const json& given = file["name"];
    if (!given.is_string() || given.get_ref<const std::string&>().empty()) {
      throw Error(ExitCode::bad_input, "{}: /name is {}; allowed: a text that is not empty", path,
                  quoted(given));
    }
    name = given.get<std::string>();
  }
  return make_basis_from_centres(name, centres_of(file["centres"], path), lambda);
}

}  // namespace clpv
