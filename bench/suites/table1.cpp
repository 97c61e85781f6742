// Suite `table1`: the paper's Table 1 in its own shape (Silvestre, 'Cascaded Light Propagation Volumes using Spherical
// Radial Basis Functions'): injection and propagation of each cascade and the light buffer, with and without indirect
// shadows, a column a basis.
#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "bench/suites.hpp"

namespace clpv::bench {
namespace {

const char* const kFirstBasis = "sh2";  // that others are held against

std::vector<std::string> bases_of(const SuiteOptions& options) {
  std::vector<std::string> bases = {kFirstBasis, "srbf4", "srbf8v2"};
  for (const std::string& basis : options.bases) {
    if (std::count(bases.begin(), bases.end(), basis) == 0) bases.push_back(basis);
  }
  return bases;
}

/// What the paper says of its times on a Radeon HD 6870, as ratios to sh2; no other figure of it is known here.
struct Published {
  Stage stage;
  bool occlusion;
  const char* basis;
  double ratio;
};
constexpr Published kPublished[] = {{Stage::propagate, true, "srbf8v2", 4.3}};

/// Where a row stands in the table.
struct Line {
  LobeKind lobe;
  LobeTime lobe_time;
  bool occlusion;
  std::string stage;
  int cascade;  ///< -1: of all
  auto operator<=>(const Line&) const = default;
};

/// What the paper calls a stage.
struct Title {
  Stage stage;
  const char* text;
};
constexpr Title kTitles[] = {
    {Stage::inject, "injection"}, {Stage::propagate, "propagation"}, {Stage::gather, "light buffer"}};

std::string title(const Line& line) {
  std::string what = line.stage;
  for (const Title& known : kTitles) {
    if (line.stage == name_of(known.stage)) what = known.text;
  }
  return line.cascade < 0 ? what : fmt::format("{}, cascade {}", what, line.cascade);
}

const char* lobes_title(const Line& line) {
  if (line.lobe_time == LobeTime::kernel) return "rotated at run time";
  switch (line.lobe) {
    case LobeKind::exact:
      return "exact, constants";
    case LobeKind::rotate:
      return "rotated, constants";
  }
  return "";
}

std::string cell(const Row* row) {
  if (row == nullptr) return "-";
  if (row->status != Status::ok) return name_of(row->status);
  return fmt::format("{:.2f}", row->times.median);
}

std::string ratio(const Row* row, const Row* first) {
  if (row == nullptr || first == nullptr || first->times.median <= 0 || row->status != Status::ok) return "-";
  return fmt::format("{:.2f}", row->times.median / first->times.median);
}

std::string published_ratio(const Line& line, const std::string& basis) {
  for (const Published& p : kPublished) {
    if (line.stage == name_of(p.stage) && line.occlusion == p.occlusion && basis == p.basis)
      return fmt::format("{:.1f}", p.ratio);
  }
  return "";
}

std::string table(const std::vector<Row>& rows) {
  std::vector<std::string> bases;
  std::vector<Line> lines;  // in the order of the rows
  std::map<std::pair<Line, std::string>, const Row*> at;
  for (const Row& row : rows) {
    if (!row.variant) continue;
    const RenderOptions& o = row.variant->options;
    const Line line{o.lobe, o.lobe_time, o.occlusion, row.stage, row.variant->cascade.value_or(-1)};
    if (std::count(bases.begin(), bases.end(), o.basis) == 0) bases.push_back(o.basis);
    if (std::count(lines.begin(), lines.end(), line) == 0) lines.push_back(line);
    at[{line, o.basis}] = &row;
  }
  const auto found = [&](const Line& line, const std::string& basis) -> const Row* {
    const auto entry = at.find({line, basis});
    return entry == at.end() ? nullptr : entry->second;
  };
  std::string text = fmt::format("{:<26}", "median [ms]");
  for (const std::string& basis : bases) text += fmt::format("{:>10}", basis);
  for (std::size_t b = 1; b < bases.size(); ++b) text += fmt::format("{:>14}", bases[b] + "/" + bases[0]);
  text += "  paper\n";
  const Line* before = nullptr;
  for (const Line& line : lines) {
    const bool same = before != nullptr && before->lobe == line.lobe && before->lobe_time == line.lobe_time &&
                      before->occlusion == line.occlusion;
    if (!same) {
      text += fmt::format("\nlobes {}, {} indirect shadows\n", lobes_title(line),
                          line.occlusion ? "with" : "without");
    }
    before = &line;
    text += fmt::format("{:<26}", title(line));
    for (const std::string& basis : bases) text += fmt::format("{:>10}", cell(found(line, basis)));
    for (std::size_t b = 1; b < bases.size(); ++b)
      text += fmt::format("{:>14}", ratio(found(line, bases[b]), found(line, bases[0])));
    for (std::size_t b = 1; b < bases.size(); ++b) {
      const std::string known = published_ratio(line, bases[b]);
      if (!known.empty()) text += fmt::format("  {}/{} {}", bases[b], bases[0], known);
    }
    text += "\n";
  }
  return text + "\npaper: on a Radeon HD 6870, the ratios to sh2 that are known of it; its times are not.\n";
}

/// How lobes come about in a part of the table.
struct LobeWay {
  LobeKind kind;
  LobeTime time;
};

std::vector<Case> cases(Bench& bench, const SuiteOptions& options, bool occlusion, const LobeWay& lobes) {
  std::vector<Case> cases;
  for (const StageJob& job : kStageJobs) {
    const bool of_all = job.stage == Stage::gather;
    const int count = of_all ? 1 : options.settings.cascades;
    for (int cascade = 0; cascade < count; ++cascade) {
      for (const std::string& basis : bases_of(options)) {
        Variant variant = plain_variant(options, basis);
        variant.options.lobe = lobes.kind, variant.options.lobe_time = lobes.time;
        variant.options.occlusion = occlusion;
        if (!of_all) variant.cascade = cascade;
        cases.push_back(stage_case(bench, "table1", job, variant));
      }
    }
  }
  return cases;
}

}  // namespace

Suite table1_suite() {
  return {"table1", "the paper's Table 1: injection and propagation a cascade, light buffer; ratios to sh2",
          [](Session& session, const SuiteOptions& options) {
            const auto bench = make_bench(session, options, options.settings);
            std::vector<Group> groups;
            for (const LobeWay& lobes :
                 {LobeWay{LobeKind::rotate, LobeTime::kernel}, {LobeKind::exact, LobeTime::host}}) {
              for (const bool occlusion : {false, true})
                groups.push_back({[bench, options, occlusion, lobes] {
                  return cases(*bench, options, occlusion, lobes);
                }});
            }
            return groups;
          },
          table};
}

}  // namespace clpv::bench
