// SPDX-License-Identifier: MIT
// Resolves URIs of scenes and models, and decodes data URIs.

#include "scene/input.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <string_view>
#include <utility>

#include "scene/bounds.hpp"
#include "support/error.hpp"
#include "support/text.hpp"

namespace tinygltf {
std::string base64_decode(const std::string& text);
}  // namespace tinygltf

namespace clpv {

namespace fs = std::filesystem;
namespace {

constexpr std::string_view kDataScheme = "data:";

/// Compares ASCII without case.
bool same_letters(std::string_view text, std::string_view lower) {
  return std::ranges::equal(text, lower, {}, [](unsigned char c) { return std::tolower(c); });
}

/// Decodes base64, with or without padding; empty for other characters and for a single last digit.
std::optional<Bytes> base64_decoded(std::string text) {
  for (int padding = 0; padding < 2 && text.ends_with('='); ++padding) text.pop_back();
  const auto digit = [](unsigned char c) { return std::isalnum(c) || c == '+' || c == '/'; };
  if (text.size() % 4 == 1 || !std::ranges::all_of(text, digit)) return std::nullopt;
  const std::string bytes = tinygltf::base64_decode(text);
  return Bytes(bytes.begin(), bytes.end());
}

}  // namespace

std::optional<std::string> percent_decoded(std::string_view uri) {
  std::string out;
  out.reserve(uri.size());
  for (std::size_t i = 0; i < uri.size(); ++i) {
    if (uri[i] != '%') {
      out += uri[i];
      continue;
    }
    if (i + 2 >= uri.size() || !std::isxdigit(static_cast<unsigned char>(uri[i + 1])) ||
        !std::isxdigit(static_cast<unsigned char>(uri[i + 2]))) {
      return std::nullopt;
    }
    out += static_cast<char>(std::stoi(std::string(uri.substr(i + 1, 2)), nullptr, 16));
    i += 2;
  }
  return out;
}

std::string excerpt(std::string_view text) {
  constexpr std::size_t kMaxLength = 160;
  std::string out(text.substr(0, kMaxLength));
  std::replace(out.begin(), out.end(), '\n', ' ');
  return text.size() > kMaxLength ? out + "..." : out;
}

fs::path resolve_uri(const fs::path& folder, const std::string& uri, const std::string& file,
                     std::string_view place) {
  const auto reject_uri = [&](const char* reason) {
    reject(file, place, fmt::format("URI '{}', {}", excerpt(uri), reason),
           "a relative path to a file in the model's folder or below");
  };
  const std::optional<std::string> decoded = percent_decoded(uri);
  if (!decoded || decoded->empty() || decoded->find('\0') != std::string::npos)
    reject_uri("malformed");
  const fs::path relative = *decoded;
  if (relative.is_absolute()) reject_uri("an absolute path");
  if (std::ranges::find(relative, fs::path("..")) != relative.end())
    reject_uri("which contains '..'");
  std::error_code failure;
  const fs::path real = fs::canonical(folder / relative, failure);
  if (failure) reject_uri("no such file");
  const fs::path home = fs::canonical(folder);
  if (std::ranges::mismatch(home, real).in1 != home.end())
    reject_uri("which leaves the model's folder");
  if (!fs::is_regular_file(real))
    reject_uri(fs::is_directory(real) ? "a folder" : "no regular file");
  return real;
}

bool is_data_uri(std::string_view uri) {
  return same_letters(uri.substr(0, kDataScheme.size()), kDataScheme);
}

Bytes decode_data_uri(const std::string& uri, const std::string& file, std::string_view place) {
  constexpr std::string_view kBase64 = ";base64";
  const std::string_view text(uri);
  const std::size_t comma = text.find(',');
  const auto reject_data = [&](const char* reason) {
    reject(file, place, fmt::format("URI '{}', {}", excerpt(text.substr(0, comma)), reason),
           "data:TYPE;base64, and base64");
  };
  if (comma == std::string_view::npos) reject_data("data without a comma");
  const std::string_view header = text.substr(0, comma);
  const bool base64 = header.size() >= kBase64.size() &&
                      same_letters(header.substr(header.size() - kBase64.size()), kBase64);
  const std::optional<std::string> content = percent_decoded(text.substr(comma + 1));
  if (!content) reject_data("whose data does not decode: malformed percent-encoding");
  if (!base64) return {content->begin(), content->end()};
  std::optional<Bytes> decoded = base64_decoded(*content);
  if (!decoded) reject_data("whose data does not decode: not base64");
  return std::move(*decoded);
}

namespace {

constexpr std::uint64_t kMaxBytes = std::uint64_t{1} << 31;
constexpr double kShortest = 1e-6;  // minimum length of a valid normal

/// Returns the line that `text` begins with; removes it.
std::string_view cut_line(std::string_view& text) {
  const std::size_t end = std::min(text.find('\n'), text.size());
  const std::string_view line = text.substr(0, end);
  text.remove_prefix(std::min(end + 1, text.size()));
  return trimmed(line);
}

/// Returns true for a header line: it begins with a letter, as no finite number does.
bool is_header(std::string_view line) {
  const char c = line.front();
  return ((c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z')) && !line.starts_with("nan") &&
         !line.starts_with("inf");
}

SurfacePoint point_of(std::string_view line, const std::string& file, const std::string& place) {
  constexpr std::size_t kShown = 60;
  const auto six =
      parse_numbers<double, 6>(line.ends_with(',') ? line.substr(0, line.size() - 1) : line);
  if (!six) {
    reject(file, place, "'" + std::string(line.substr(0, kShown)) + "'",
           "six finite numbers between commas: x,y,z,nx,ny,nz");
  }
  const auto& v = *six;
  const glm::dvec3 position(v[0], v[1], v[2]), normal(v[3], v[4], v[5]);
  if (glm::any(glm::greaterThan(glm::abs(position), glm::dvec3(bounds::kCoordinate)))) {
    reject(file, place, fmt::format("({}, {}, {}) m", v[0], v[1], v[2]),
           fmt::format("coordinates within +-{} m", bounds::kCoordinate));
  }
  const double length = glm::length(normal);
  if (!(length >= kShortest) || !std::isfinite(length))
    reject(file, place, fmt::format("a normal of length {}", length), "a direction");
  return {position, normal / length};
}

}  // namespace

std::vector<SurfacePoint> read_points(const std::filesystem::path& path) {
  const std::string file = path.string();
  const Bytes bytes = read_file(path, kMaxBytes, file);
  std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);  // a byte order mark
  std::vector<SurfacePoint> points;
  bool first = true;
  for (std::size_t number = 1; !text.empty(); ++number) {
    const std::string_view line = cut_line(text);
    if (line.empty() || line.front() == '#') continue;
    const bool header = std::exchange(first, false) && is_header(line);
    if (header) continue;
    const std::string place = fmt::format("line {}", number);
    if (points.size() == kMaxPoints)
      reject(file, place, "one more point", fmt::format("at most {}", kMaxPoints));
    points.push_back(point_of(line, file, place));
  }
  return points;
}

}  // namespace clpv
