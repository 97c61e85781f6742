// Charts as inline SVG, drawn in the page's own colours.
#pragma once

#include <string>
#include <vector>

namespace clpv::report {

struct Point {
  double x = 0, y = 0;
  std::string name;    ///< shown when pointed at; of marked points, beside them
  std::string series;  ///< points of one series share colour and legend entry
  bool marked = false;
};

/// A scatter plot of positive x (logarithmic) against y from 0, and the front of points that no other beats in both.
std::string scatter(const std::vector<Point>& points, const std::string& x_title, const std::string& y_title);

struct Bar {
  std::string group, name;
  double value = 0;
};

/// Horizontal bars on a logarithmic scale, a heading a group, values beside them.
std::string bars(const std::vector<Bar>& bars, const std::string& title);

/// `text` with the characters that HTML and SVG would read as markup written out.
std::string escaped(const std::string& text);

}  // namespace clpv::report
