// SPDX-License-Identifier: MIT
#include "scene/input.hpp"

#include <algorithm>
#include <cctype>
#include <nlohmann/json.hpp>
#include <optional>

#include "scene/bounds.hpp"
#include "support/error.hpp"

namespace clpv {
namespace fs = std::filesystem;
namespace {

/// Bounds the depth of brackets and the number of values, without recursion and before a parser allocates for
/// them.
void check_extent(std::string_view text, const std::string& file) {
  int depth = 0;
  std::uint64_t values = 0;
  bool quoted = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (quoted) {
      if (c == '\\') ++i;
      if (c == '"') quoted = false;
    } else if (c == '"') {
      quoted = true;
    } else if (c == '[' || c == '{') {
      if (++depth > bounds::kJsonNesting) {
        refuse(file, {}, fmt::format("JSON nested more than {} deep at byte {}", bounds::kJsonNesting, i),
               fmt::format("at most {} levels", bounds::kJsonNesting));
      }
    } else if (c == ']' || c == '}') {
      --depth;
    } else if (c == ',' && ++values > bounds::kJsonValues) {
      refuse(file, {}, fmt::format("more than {} JSON values", bounds::kJsonValues), "at most as many");
    }
  }
}

std::optional<std::string> percent_decoded(std::string_view uri) {
  std::string out;
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

bool lies_in(const fs::path& path, const fs::path& folder) {
  const auto [in_folder, in_path] = std::mismatch(folder.begin(), folder.end(), path.begin(), path.end());
  return in_folder == folder.end();
}

}  // namespace

std::string shown(std::string_view text) {
  constexpr std::size_t kShown = 160;
  std::string out(text.substr(0, kShown));
  std::replace(out.begin(), out.end(), '\n', ' ');
  return text.size() > kShown ? out + "..." : out;
}

nlohmann::json parse_json(std::string_view text, const std::string& file) {
  if (text.size() > bounds::kJsonBytes) {
    refuse(file, {}, fmt::format("{} bytes of JSON", text.size()),
           fmt::format("at most {}", bounds::kJsonBytes));
  }
  check_extent(text, file);
  try {
    return nlohmann::json::parse(text);
  } catch (const nlohmann::json::exception& error) {  // its text carries line and column
    std::string what = error.what();
    std::erase_if(what, [](unsigned char c) { return c < 0x20 && c != '\t'; });
    refuse(file, {}, "no JSON: " + what, "well-formed JSON in UTF-8, numbers within double's range");
  }
}

fs::path resolve_uri(const fs::path& folder, const std::string& uri, const std::string& file,
                     std::string_view place) {
  const auto refuse_uri = [&](const char* why) {
    refuse(file, place, fmt::format("URI '{}', {}", shown(uri), why),
           "a relative path to a file in the model's folder or below");
  };
  const std::optional<std::string> decoded = percent_decoded(uri);
  if (!decoded || decoded->empty() || decoded->find('\0') != std::string::npos) refuse_uri("malformed");
  std::error_code failure;
  const fs::path real = fs::canonical(folder / *decoded, failure);
  if (failure) refuse_uri("no such file");
  if (!lies_in(real, fs::canonical(folder))) refuse_uri("which leaves the model's folder");
  if (!fs::is_regular_file(real)) refuse_uri(fs::is_directory(real) ? "a folder" : "no regular file");
  return real;
}

}  // namespace clpv
