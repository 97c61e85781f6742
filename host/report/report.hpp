// One self-contained page: what the frames look like beside the truth, how far off they are, and what they cost.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "image/image.hpp"

namespace clpv::report {

/// A way to render, under the name readers see: "published", "ours".
struct Shot {
  std::string title;
  std::string options;  ///< what made it: "--preset paper"
  Image image;          ///< linear, of the view's size
};

/// What one camera sees: the truth and each way's image of it. All images have the same size.
struct View {
  std::string scene, camera;
  float exposure = 0;  ///< EV
  Image truth;
  std::vector<Shot> shots;
};

/// What a page is made of. What is missing is left out of the page, which says how to come by it.
struct Contents {
  std::string subtitle;  ///< device, size, what is shown
  std::vector<View> views;
  std::vector<nlohmann::json> quality;     ///< documents of `clpv quality --json`
  std::vector<nlohmann::json> benchmarks;  ///< documents of `clpv bench --format json`
  std::vector<std::string> marked;  ///< variants of `quality` to mark in the chart: "the paper", "best"
};

/// The whole HTML file: no script, style, font or image from anywhere else. Throws Error(bad_input) where a document
/// is not of the shape its command writes.
std::string page(const Contents& contents);

}  // namespace clpv::report
