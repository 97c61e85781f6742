// SPDX-License-Identifier: MIT
// Suite `table1`: the paper's Table 1 in its own shape (Silvestre and Pereira, 'Cascaded Light Propagation Volumes using
// Spherical Radial Basis Functions'), its times beside ours: injection and propagation of each cascade and the light
// buffer, with and without indirect shadows, a column a basis. The published injection gains .033 ms at most from
// indirect shadows, too little for another volume: ours has the geometry volume in rows of its own.
#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "bench/published.hpp"
#include "bench/suites.hpp"

namespace clpv::bench {
namespace {

constexpr const char* kFirstBasis = "sh2";  // that others are held against
constexpr const char* kSizes[] = {"small", "medium", "big"};

std::vector<std::string> bases_of(const SuiteOptions& options) {
  std::vector<std::string> bases = {kFirstBasis, "srbf4", "srbf8v2"};
  for (const std::string& basis : options.bases) {
    if (std::count(bases.begin(), bases.end(), basis) == 0) bases.push_back(basis);
  }
  return bases;
}

/// The paper's settings, and the same scheme as clpv would have it: buffers, and lobes that are constants of the code.
enum class Part { published, constants };

const char* title(Part part) {
  return part == Part::published ? "--preset paper, as published"
                                 : "in buffers of floats, lobes constants of the code";
}

/// A row of the paper's table, or one beside it.
struct Line {
  Pass pass;
  const char* title;
  bool every_cascade;
};
constexpr Line kLines[] = {{Pass::inject_light, "injection", true},
                           {Pass::inject_geometry, "geometry volume", true},
                           {Pass::propagate, "propagation", true},
                           {Pass::gather, "light buffer", false}};

/// Where a time stands.
struct Place {
  Part part;
  bool shadows;
  Pass pass;
  int cascade;  ///< -1: of all
  std::string basis;
  auto operator<=>(const Place&) const = default;
};

Part part_of(const RenderOptions& options) {
  return options.lobe_time == LobeTime::kernel ? Part::published : Part::constants;
}

/// A column's times: printed in the paper, and measured here, or why not.
struct Times {
  std::optional<double> published, here;
  std::string status = "-";
};

class Measured {
 public:
  explicit Measured(const std::vector<Row>& rows) {
    for (const Row& row : rows) {
      if (!row.variant) continue;
      const RenderOptions& o = row.variant->options;
      for (const Line& line : kLines) {
        if (row.stage != name_of(line.pass)) continue;
        const Place place{part_of(o), o.occlusion, line.pass, row.variant->cascade.value_or(-1), o.basis};
        const bool timed = row.status == Status::ok;
        times_[place] = {row.published_ms, timed ? std::optional(row.times.median) : std::nullopt,
                         std::string(name_of(row.status))};
        if (std::count(bases_.begin(), bases_.end(), o.basis) == 0) bases_.push_back(o.basis);
        cascades_ = std::max(cascades_, place.cascade + 1);
      }
    }
  }
  const std::vector<std::string>& bases() const { return bases_; }
  int cascades() const { return cascades_; }
  bool has(Part part, bool shadows) const {
    return std::ranges::any_of(times_, [&](const auto& entry) {
      return entry.first.part == part && entry.first.shadows == shadows;
    });
  }
  Times at(const Place& place) const {
    const auto found = times_.find(place);
    if (found != times_.end()) return found->second;
    const auto cascade = place.cascade < 0 ? std::nullopt : std::optional(place.cascade);
    return {published_ms(place.pass, place.basis, place.shadows, cascade), std::nullopt};
  }

 private:
  std::map<Place, Times> times_;
  std::vector<std::string> bases_;
  int cascades_ = 0;
};

std::string cell(const std::optional<double>& value, int digits, const std::string& otherwise = "-") {
  constexpr int kWidth = 9;
  return value ? fmt::format("{:>{}.{}f}", *value, kWidth, digits)
               : fmt::format("{:>{}.8}", otherwise, kWidth);
}

std::optional<double> over(const std::optional<double>& a, const std::optional<double>& b) {
  return a && b && *b > 0 ? std::optional(*a / *b) : std::nullopt;
}

/// A line of the table: times of each basis, then their ratios to the first one's.
std::string line_text(const std::string& title, const std::vector<Times>& columns) {
  std::string text = fmt::format("{:<24}", title);
  for (const Times& times : columns) text += cell(times.published, 3) + cell(times.here, 2, times.status);
  for (std::size_t b = 1; b < columns.size(); ++b) {
    text += cell(over(columns[b].published, columns[0].published), 2) +
            cell(over(columns[b].here, columns[0].here), 2);
  }
  return text + "\n";
}

std::string head(const std::vector<std::string>& bases) {
  std::string first = fmt::format("{:<24}", "[ms]"), second = fmt::format("{:<24}", "");
  for (const std::string& basis : bases) first += fmt::format("{:>18}", basis);
  for (std::size_t b = 1; b < bases.size(); ++b) first += fmt::format("{:>18}", bases[b] + "/" + bases[0]);
  for (std::size_t b = 1; b < 2 * bases.size(); ++b) second += fmt::format("{:>9}{:>9}", "paper", "here");
  return first + "\n" + second + "\n";
}

/// A sum is there where each of its terms is.
void add(Times& sum, const Times& times) {
  const auto plus = [](std::optional<double>& a, const std::optional<double>& b) {
    a = a && b ? std::optional(*a + *b) : std::nullopt;
  };
  plus(sum.published, times.published);
  plus(sum.here, times.here);
}

std::string part_text(const Measured& measured, Part part, bool shadows) {
  std::string text = fmt::format("\n{}, {} indirect shadows\n", title(part), shadows ? "with" : "without");
  std::vector<Times> sums(measured.bases().size(), {0.0, 0.0}), with_geometry = sums;
  for (const Line& line : kLines) {
    if (line.pass == Pass::inject_geometry && !shadows) continue;
    for (int cascade = 0; cascade < (line.every_cascade ? measured.cascades() : 1); ++cascade) {
      std::vector<Times> columns;
      for (std::size_t b = 0; b < measured.bases().size(); ++b) {
        columns.push_back(
            measured.at({part, shadows, line.pass, line.every_cascade ? cascade : -1, measured.bases()[b]}));
        add(with_geometry[b], columns.back());
        if (line.pass != Pass::inject_geometry) add(sums[b], columns.back());
      }
      const bool named = line.every_cascade && cascade < static_cast<int>(std::size(kSizes));
      text += line_text(named ? fmt::format("{}, {}", line.title, kSizes[cascade]) : line.title, columns);
    }
  }
  text += line_text("sum", sums);
  return shadows ? text + line_text("with geometry volume", with_geometry) : text;
}

std::string table1_table(const std::vector<Row>& rows) {
  const Measured measured(rows);
  std::string text = head(measured.bases());
  for (const Part part : {Part::published, Part::constants}) {
    for (const bool shadows : {true, false}) {
      if (measured.has(part, shadows)) text += part_text(measured, part, shadows);
    }
  }
  return text + "\npaper: on a Radeon HD 6870, its Table 1; here: medians.\n";
}

/// What a row of that part is timed with.
Variant variant_of(const SuiteOptions& options, Part part, const std::string& basis) {
  Variant variant = plain_variant(options, basis);
  if (part == Part::published) variant.options = published_options(options.settings, basis);
  return variant;
}

std::vector<Case> cases(Bench& bench, const SuiteOptions& options, Part part, bool shadows) {
  std::vector<Case> cases;
  for (const StageJob& job : {kInjectLight, kInjectGeometry, kPropagate, kGather}) {
    if (job.part == Pass::inject_geometry && !shadows) continue;
    const bool of_all = job.stage == Stage::gather;
    for (int cascade = 0; cascade < (of_all ? 1 : options.settings.cascades); ++cascade) {
      for (const std::string& basis : bases_of(options)) {
        Variant variant = variant_of(options, part, basis);
        variant.options.occlusion = shadows;
        if (!of_all) variant.cascade = cascade;
        Case made = stage_case(bench, "table1", job, variant);
        made.row.published_ms = published_ms(job.part, basis, shadows, variant.cascade);
        cases.push_back(std::move(made));
      }
    }
  }
  return cases;
}

}  // namespace

Suite table1_suite() {
  return {"table1",
          "the paper's Table 1, its times beside ours: injection and propagation a cascade, light buffer; "
          "ratios to sh2",
          [](Session& session, const SuiteOptions& options) {
            std::vector<Group> groups;
            for (const Part part : {Part::published, Part::constants}) {
              const auto bench = make_bench(session, options, variant_of(options, part, kFirstBasis).options);
              for (const bool shadows : {true, false})
                groups.push_back(
                    {[bench, options, part, shadows] { return cases(*bench, options, part, shadows); }});
            }
            return groups;
          },
          table1_table, "scenes/atrium.json"};
}

}  // namespace clpv::bench
