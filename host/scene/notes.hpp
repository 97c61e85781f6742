// SPDX-License-Identifier: MIT
// Notes of the loader to the user, bounded in number against hostile files.
#pragma once

#include <algorithm>
#include <string>
#include <string_view>
#include <vector>

#include "scene/bounds.hpp"

namespace clpv {

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

}  // namespace clpv
