// SPDX-License-Identifier: MIT
// Resolves URIs of scenes and models.
#include "scene/input.hpp"

#include <algorithm>
#include <cctype>

#include "support/error.hpp"

namespace clpv {
namespace fs = std::filesystem;
namespace {

bool lies_in(const fs::path& path, const fs::path& folder) {
  const auto [in_folder, in_path] =
      std::mismatch(folder.begin(), folder.end(), path.begin(), path.end());
  return in_folder == folder.end();
}

}  // namespace

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
  if (!lies_in(real, fs::canonical(folder))) reject_uri("which leaves the model's folder");
  if (!fs::is_regular_file(real))
    reject_uri(fs::is_directory(real) ? "a folder" : "no regular file");
  return real;
}

}  // namespace clpv
