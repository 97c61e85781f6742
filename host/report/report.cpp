#include "report/report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>

#include "image/compare.hpp"
#include "image/tone_map.hpp"
#include "report/chart.hpp"
#include "report/document.hpp"
#include "report/picture.hpp"
#include "support/error.hpp"

namespace clpv::report {
namespace {

using nlohmann::json;

constexpr double kFullScale = 1.5;  // of false colour, in root mean squares of the truth

std::string percent(double share) {
  return fmt::format("{:.1f} %", 100 * share);
}

std::string shown(const Image& image, float exposure) {
  return data_uri(display_image(image, exposure, ToneMap::aces));
}

// ---- views ----

std::string figure(const std::string& uri, const std::string& caption) {
  return fmt::format(
      "<figure><img src=\"{}\" alt=\"{}\" loading=\"lazy\"><figcaption>{}</figcaption></figure>\n", uri,
      escaped(caption), escaped(caption));
}

std::string caption(const Shot& shot, const Comparison& error) {
  if (!error.nrmse_valid) return shot.title + ": the truth is black, an error has no measure";
  return fmt::format("{}: NRMSE {}, after the best gain {}, energy {:.2f} of the truth", shot.title,
                     percent(*error.nrmse_valid), percent(error.nrmse_best_gain.value_or(0)),
                     error.energy_ratio.value_or(0));
}

std::string view_section(const View& view) {
  const std::string truth = shown(view.truth, view.exposure);
  std::string html = fmt::format("<h3>{}, {}</h3>\n", escaped(view.scene), escaped(view.camera));
  std::string images = figure(truth, "truth: path tracing, one bounce"), errors;
  std::vector<std::string> uris;
  for (const Shot& shot : view.shots) {
    const Comparison error = compare(shot.image, shot.title, view.truth, "truth");
    uris.push_back(shown(shot.image, view.exposure));
    images += figure(uris.back(), caption(shot, error));
    errors += figure(data_uri(false_colour(shot.image, view.truth, kFullScale)), "error of " + shot.title);
  }
  if (!uris.empty()) html += wipe(truth, "truth", uris.back(), view.shots.back().title);
  if (uris.size() > 1)
    html += wipe(uris.front(), view.shots.front().title, uris.back(), view.shots.back().title);
  return html + "<div class=\"row\">" + images + errors + "</div>\n";
}

std::string views_section(const std::vector<View>& views) {
  std::string html = "<h2>What it looks like</h2>\n";
  if (views.empty())
    return html + "<p class=\"soft\">No views: give scenes to <code>clpv report</code>.</p>\n";
  html += fmt::format(
      "<p>Indirect light alone. Errors are absolute differences of luminance, from 0 to {} times the root "
      "mean square of the truth:</p>\n<div class=\"legend\">0 <img src=\"{}\" alt=\"colours of errors\"> "
      "{}</div>\n",
      kFullScale, data_uri(legend(256, 12)), kFullScale);
  for (const Shot& shot : views[0].shots)
    html += fmt::format("<p class=\"soft\">{}: <code>clpv render {}</code></p>\n", escaped(shot.title),
                        escaped(shot.options));
  for (const View& view : views) html += view_section(view);
  return html;
}

// ---- quality against cost ----

std::string described(const json& options) {
  std::string text;
  for (const auto& [name, value] : options.items())
    text += fmt::format("{}{}", text.empty() ? "" : " ",
                        value.is_string() ? value.get<std::string>() : value.dump());
  return text;
}

struct Entry {
  std::string name, series;
  double nrmse, worst, energy, ms;
  bool marked;
};

std::vector<Entry> entries(const Contents& contents) {
  std::vector<Entry> result;
  for (const json& document : contents.quality) {
    for (const json& variant : document.at("variants")) {
      if (variant.at("refused") != 0) continue;
      const json& options = variant.at("options");
      const std::string name = described(options);
      const json series = options.contains("transport") ? options["transport"] : json("preset");
      result.push_back({name, series.get<std::string>(), variant.at("nrmse"), variant.at("worst_nrmse"),
                        variant.at("energy_ratio"), variant.at("frame_ms"),
                        std::ranges::count(contents.marked, name) > 0});
    }
  }
  std::ranges::stable_sort(result, {}, &Entry::nrmse);
  return result;
}

std::string quality_section(const Contents& contents) {
  std::string html = "<h2>Error against cost</h2>\n";
  const std::vector<Entry> all = entries(contents);
  if (all.empty())
    return html +
           "<p class=\"soft\">No figures: give <code>--quality FILE</code>, made by <code>clpv quality "
           "--json "
           "FILE</code>.</p>\n";
  std::vector<Point> points;
  for (const Entry& e : all) points.push_back({e.ms, 100 * e.nrmse, e.name, e.series, e.marked});
  html +=
      "<p>Each point is a variant: the mean error over all views (NRMSE) against the milliseconds of a "
      "frame. The dashed "
      "line joins those that none beats in both.</p>\n" +
      scatter(points, "frame [ms]", "mean NRMSE [%]");
  html +=
      "<div class=\"scroll\"><table><tr><th>variant</th><th>mean NRMSE</th><th>worst "
      "view</th><th>energy</th><th>frame "
      "ms</th></tr>\n";
  for (const Entry& e : all)
    html += fmt::format("<tr{}><td>{}</td><td>{}</td><td>{}</td><td>{:.2f}</td><td>{:.1f}</td></tr>\n",
                        e.marked ? " class=\"marked\"" : "", escaped(e.name), percent(e.nrmse),
                        percent(e.worst), e.energy, e.ms);
  return html + "</table></div>\n";
}

// ---- benchmarks ----

std::vector<json> rows_of(const Contents& contents, const std::string& suite) {
  std::vector<json> rows;
  for (const json& document : contents.benchmarks) {
    for (const json& row : document.at("benchmarks")) {
      if (row.at("suite") == suite) rows.push_back(row);
    }
  }
  return rows;
}

std::string missing(const std::string& suite) {
  return fmt::format(
      "<p class=\"soft\">No figures: give <code>--bench FILE</code>, made by <code>clpv bench {0} --format "
      "json "
      "--out FILE</code>.</p>\n",
      suite);
}

std::string text_or(const json& value, const std::string& other) {
  return value.is_string() ? value.get<std::string>() : other;
}

/// The paper's Table 1: a line a stage and cascade, a column a basis.
std::string table1_section(const Contents& contents) {
  std::string html = "<h2>The paper's Table 1</h2>\n";
  const std::vector<json> rows = rows_of(contents, "table1");
  if (rows.empty()) return html + missing("table1");
  std::vector<std::string> bases, lines;
  std::map<std::pair<std::string, std::string>, std::string> cells;
  for (const json& row : rows) {
    const std::string basis = text_or(row.at("basis"), "-");
    const json& cascade = row.at("cascade");
    const std::string line =
        fmt::format("{}{}, lobes {}, {} indirect shadows", text_or(row.at("stage"), "-"),
                    cascade.is_number() ? fmt::format(" cascade {}", cascade.get<int>()) : "",
                    text_or(row.at("lobe"), "-"), row.at("occlusion") == true ? "with" : "without");
    if (std::ranges::count(bases, basis) == 0) bases.push_back(basis);
    if (std::ranges::count(lines, line) == 0) lines.push_back(line);
    cells[{line, basis}] = row.at("status") == "ok" ? fmt::format("{:.3g}", row.at("median").get<double>())
                                                    : text_or(row.at("status"), "-");
  }
  html += "<p>Median milliseconds on this device.</p>\n<div class=\"scroll\"><table><tr><th>stage</th>";
  for (const std::string& basis : bases) html += fmt::format("<th>{}</th>", escaped(basis));
  html += "</tr>\n";
  for (const std::string& line : lines) {
    html += fmt::format("<tr><td>{}</td>", escaped(line));
    for (const std::string& basis : bases) html += fmt::format("<td>{}</td>", escaped(cells[{line, basis}]));
    html += "</tr>\n";
  }
  return html + "</table></div>\n";
}

std::string layouts_section(const Contents& contents) {
  std::string html = "<h2>Volume layouts</h2>\n";
  std::vector<Bar> chart;
  std::string unsupported;
  for (const json& row : rows_of(contents, "layouts")) {
    const std::string name = text_or(row.at("layout"), "-") + " " + text_or(row.at("storage"), "-");
    const std::string group = text_or(row.at("stage"), "-") + ", " + text_or(row.at("basis"), "-");
    if (row.at("status") == "ok")
      chart.push_back({group, name, row.at("median")});
    else
      unsupported +=
          fmt::format("<p class=\"soft\">{}, {}: {}, {}</p>\n", escaped(group), escaped(name),
                      escaped(text_or(row.at("status"), "-")), escaped(text_or(row.at("reason"), "")));
  }
  if (chart.empty() && unsupported.empty()) return html + missing("layouts");
  std::ranges::stable_sort(chart, {}, &Bar::group);
  return html + "<p>Median milliseconds, on a logarithmic scale; shorter is better.</p>\n" +
         bars(chart, "milliseconds of each volume layout") + unsupported;
}

}  // namespace

std::string page(const Contents& contents) {
  try {
    const std::string body =
        "<h1>clpv: cascaded light propagation volumes, measured</h1>\n<p class=\"soft\">" +
        escaped(contents.subtitle) + "</p>\n" + views_section(contents.views) + quality_section(contents) +
        table1_section(contents) + layouts_section(contents);
    return document("clpv report", body);
  } catch (const json::exception& error) {
    throw Error(ExitCode::bad_input,
                "a document for the report is not what clpv quality or clpv bench writes: {}", error.what());
  }
}

}  // namespace clpv::report
