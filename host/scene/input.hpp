// SPDX-License-Identifier: MIT
// URIs in untrusted files: files in the model's folder, and data.
#pragma once

#include <algorithm>
#include <filesystem>
#include <glm/glm.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "scene/bounds.hpp"
#include "support/error.hpp"
#include "support/input_file.hpp"

namespace clpv {

/// Up to 160 bytes of a text on one line, for messages.
std::string excerpt(std::string_view text);

/// Returns the text with its %XX decoded; nothing if one is malformed.
std::optional<std::string> percent_decoded(std::string_view uri);

/// Canonical path of the relative URI `uri` in `file`, percent-decoded, with links resolved.
/// `folder` must be canonical. Throws Error(bad_input) for absolute paths, `..`, links that lead
/// outside `folder`, and all but regular files.
std::filesystem::path resolve_uri(const std::filesystem::path& folder, const std::string& uri,
                                  const std::string& file, std::string_view place);

/// Decodes "%20" and the like; empty if malformed.
std::optional<std::string> percent_decoded(std::string_view uri);

/// Returns true for "data:...", in any case (RFC 3986, section 3.1).
bool is_data_uri(std::string_view uri);

/// Bytes of a data URI (RFC 2397): base64, or percent-encoded text. The media type, which may be
/// absent, is not used: the content determines the format. Throws Error(bad_input) for a URI
/// without a comma, and for characters that are not base64.
Bytes decode_data_uri(const std::string& uri, const std::string& file, std::string_view place);

// Notes of the loader to the user, bounded in number against hostile files.

/// Stores the first bounds::kNotes different notes and counts the others.
class Notes {
 public:
  void add(std::string_view note) {
    if (std::ranges::find(notes_, note) != notes_.end()) return;
    if (notes_.size() < bounds::kNotes) {
      notes_.emplace_back(note);
    } else {
      ++more_;
    }
  }

  /// Returns the notes in order, and a last one with the number of omitted notes.
  std::vector<std::string> take() {
    if (more_ > 0) notes_.push_back("and " + std::to_string(more_) + " more notes like these");
    more_ = 0;
    return std::move(notes_);
  }

 private:
  std::vector<std::string> notes_;
  std::size_t more_ = 0;
};

// Reader of surface points from a CSV file.

struct SurfacePoint {
  glm::dvec3 position;  ///< [m]
  glm::dvec3 normal;    ///< unit
};

/// Reads lines of x,y,z,nx,ny,nz with an optional header line. Skips empty lines and lines that
/// begin with #. Normalises the normals. Throws Error(bad_input) with the line number for invalid
/// numbers, coordinates outside the range of scenes, normals without length, and more points than
/// kMaxPoints.
std::vector<SurfacePoint> read_points(const std::filesystem::path& file);

inline constexpr std::size_t kMaxPoints = std::size_t{1} << 24;

}  // namespace clpv
