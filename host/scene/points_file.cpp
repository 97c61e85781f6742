// SPDX-License-Identifier: MIT
#include "scene/points_file.hpp"

#include <fmt/format.h>

#include <cmath>
#include <string_view>
#include <utility>

#include "scene/bounds.hpp"
#include "scene/input.hpp"
#include "support/text.hpp"

namespace clpv {
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
