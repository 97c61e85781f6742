#include "report/chart.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace clpv::report {
namespace {

// The drawing's own units; the page scales them to its width.
constexpr double kWidth = 760, kHeight = 430;
constexpr double kLeft = 58, kRight = 16, kTop = 14, kBottom = 46;

/// From values to places along an axis.
struct Axis {
  double low, high;  // values
  double from, to;   // places
  bool logarithmic;

  double place(double value) const {
    const double share =
        logarithmic ? std::log(value / low) / std::log(high / low) : (value - low) / (high - low);
    return from + share * (to - from);
  }
};

/// 1, 2 and 5 times powers of ten within the axis.
std::vector<double> ticks(const Axis& axis) {
  std::vector<double> result;
  if (!axis.logarithmic) {
    const double step = std::pow(10, std::floor(std::log10(axis.high - axis.low)));
    const double every = (axis.high - axis.low) / step < 3 ? step / 4 : step / 2;
    for (double v = axis.low; v <= axis.high * (1 + 1e-9); v += every) result.push_back(v);
    return result;
  }
  for (double decade = std::pow(10, std::floor(std::log10(axis.low))); decade <= axis.high; decade *= 10) {
    for (const double m : {1.0, 2.0, 5.0}) {
      if (m * decade >= axis.low && m * decade <= axis.high) result.push_back(m * decade);
    }
  }
  return result;
}

std::string frame(const Axis& x, const Axis& y, const std::string& x_title, const std::string& y_title) {
  std::string svg;
  for (const double v : ticks(x)) {
    svg += fmt::format(
        "<line class='grid' x1='{0:.1f}' x2='{0:.1f}' y1='{1}' y2='{2}'/>"
        "<text x='{0:.1f}' y='{3}' text-anchor='middle'>{4:g}</text>",
        x.place(v), y.from, y.to, y.from + 16, v);
  }
  for (const double v : ticks(y)) {
    svg += fmt::format(
        "<line class='grid' x1='{1}' x2='{2}' y1='{0:.1f}' y2='{0:.1f}'/>"
        "<text x='{3}' y='{4:.1f}' text-anchor='end'>{5:g}</text>",
        y.place(v), x.from, x.to, x.from - 6, y.place(v) + 4, v);
  }
  return svg + fmt::format(
                   "<text x='{:.1f}' y='{}' text-anchor='middle'>{}</text>"
                   "<text transform='translate(14 {:.1f}) rotate(-90)' text-anchor='middle'>{}</text>",
                   (x.from + x.to) / 2, kHeight - 8, escaped(x_title), (y.from + y.to) / 2, escaped(y_title));
}

/// Points that none beats in both x and y, by growing x.
std::vector<Point> front_of(std::vector<Point> points) {
  std::ranges::sort(points,
                    [](const Point& a, const Point& b) { return std::pair(a.x, a.y) < std::pair(b.x, b.y); });
  std::vector<Point> front;
  for (const Point& point : points) {
    if (front.empty() || point.y < front.back().y) front.push_back(point);
  }
  return front;
}

std::vector<std::string> series_of(const std::vector<Point>& points) {
  std::vector<std::string> series;
  for (const Point& point : points) {
    if (std::ranges::count(series, point.series) == 0) series.push_back(point.series);
  }
  return series;
}

std::string front_line(const std::vector<Point>& front, const Axis& x, const Axis& y) {
  std::string path = fmt::format("M{:.1f} {:.1f}", x.place(front[0].x), y.place(front[0].y));
  for (const Point& p : front)  // a staircase: nothing lies between two points
    path += fmt::format(" H{:.1f} V{:.1f}", x.place(p.x), y.place(p.y));
  return fmt::format("<path class='front' d='{}'/>", path);
}

std::string dots(const std::vector<Point>& points, const Axis& x, const Axis& y) {
  const std::vector<std::string> series = series_of(points);
  std::string svg;
  for (const Point& p : points) {
    const auto colour = std::ranges::find(series, p.series) - series.begin();
    svg += fmt::format("<circle class='s{}{}' cx='{:.1f}' cy='{:.1f}' r='{}'><title>{}</title></circle>",
                       colour % 6, p.marked ? " marked" : "", x.place(p.x), y.place(p.y), p.marked ? 7 : 4.5,
                       escaped(p.name));
    if (!p.marked) continue;
    const bool left = x.place(p.x) > kWidth * .6;
    svg += fmt::format("<text class='label' x='{:.1f}' y='{:.1f}' text-anchor='{}'>{}</text>",
                       x.place(p.x) + (left ? -12 : 12), y.place(p.y) - 8, left ? "end" : "start",
                       escaped(p.name));
  }
  for (std::size_t s = 0; s < series.size(); ++s) {
    const double at = kTop + 14 + 18 * static_cast<double>(s);
    svg += fmt::format(
        "<circle class='s{}' cx='{}' cy='{}' r='5'/><text x='{}' y='{}' text-anchor='end'>{}</text>", s % 6,
        kWidth - kRight - 10, at, kWidth - kRight - 22, at + 4, escaped(series[s]));
  }
  return svg;
}

}  // namespace

std::string escaped(const std::string& text) {
  std::string result;
  for (const char c : text) {
    switch (c) {
      case '&':
        result += "&amp;";
        break;
      case '<':
        result += "&lt;";
        break;
      case '>':
        result += "&gt;";
        break;
      case '"':
        result += "&quot;";
        break;
      case '\'':
        result += "&#39;";
        break;
      default:
        result += c;
    }
  }
  return result;
}

std::string scatter(const std::vector<Point>& points, const std::string& x_title,
                    const std::string& y_title) {
  if (points.empty()) return "";
  double low = points[0].x, high = low, top = 0;
  for (const Point& p : points)
    low = std::min(low, p.x), high = std::max(high, p.x), top = std::max(top, p.y);
  const Axis x{low * .85, high * 1.2, kLeft, kWidth - kRight, true};
  const Axis y{0, top * 1.08, kHeight - kBottom, kTop, false};
  return fmt::format("<svg class='chart' viewBox='0 0 {} {}' role='img' aria-label='{} against {}'>", kWidth,
                     kHeight, escaped(y_title), escaped(x_title)) +
         frame(x, y, x_title, y_title) + front_line(front_of(points), x, y) + dots(points, x, y) + "</svg>";
}

std::string bars(const std::vector<Bar>& bars, const std::string& title) {
  if (bars.empty()) return "";
  double low = bars[0].value, high = low;
  for (const Bar& bar : bars) low = std::min(low, bar.value), high = std::max(high, bar.value);
  const Axis x{low / 2, high * 1.1, 170, kWidth - 90, true};
  std::string svg, group;
  double at = kTop + 8;
  for (const Bar& bar : bars) {
    if (bar.group != group) {
      group = bar.group;
      at += 14;
      svg += fmt::format("<text class='label' x='8' y='{:.1f}'>{}</text>", at, escaped(group));
      at += 8;
    }
    svg += fmt::format(
        "<text x='162' y='{:.1f}' text-anchor='end'>{}</text><rect class='s0' x='{}' y='{:.1f}' "
        "width='{:.1f}' "
        "height='13'/><text x='{:.1f}' y='{:.1f}'>{:.3g}</text>",
        at + 11, escaped(bar.name), x.from, at, std::max(1.0, x.place(bar.value) - x.from),
        x.place(bar.value) + 6, at + 11, bar.value);
    at += 18;
  }
  return fmt::format("<svg class='chart' viewBox='0 0 {} {:.0f}' role='img' aria-label='{}'>{}</svg>", kWidth,
                     at + kBottom / 2, escaped(title), svg);
}

}  // namespace clpv::report
