// SPDX-License-Identifier: MIT
// What the loader decided and a user should be told, bounded: a hostile file must not flood the terminal.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "scene/bounds.hpp"

namespace clpv {

class Notes {
 public:
  void add(std::string_view note) {
    if (notes_.size() < bounds::kNotes) {
      notes_.emplace_back(note);
    } else {
      ++more_;
    }
  }

  /// The notes in order, the last one counting what was left out.
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
