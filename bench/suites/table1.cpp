// SPDX-License-Identifier: MIT
// Suite `table1`: Table 1 of the paper (Silvestre and Pereira, 'Cascaded Light Propagation Volumes
// using Spherical Radial Basis Functions') with published and measured times. Rows are injection
// and propagation of each cascade and the light buffer, with and without indirect shadows; columns
// are bases. Injection of the geometry volume has separate rows: published times of injection
// differ by at most 0.033 ms with indirect shadows, and thus do not include it.
#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "bench/published.hpp"
#include "bench/suites.hpp"

namespace clpv::bench {
namespace {

constexpr const char* kFirstBasis = "sh2";  // denominator of the ratios
constexpr const char* kSizes[] = {"small", "medium", "big"};

std::vector<std::string> bases_of(const SuiteOptions& options) {
  std::vector<std::string> bases = {kFirstBasis, "srbf4", "srbf8v2"};
  for (const std::string& basis : options.bases) {
    if (std::count(bases.begin(), bases.end(), basis) == 0) bases.push_back(basis);
  }
  return bases;
}

/// Settings of a part of the table: the paper's, or the paper's scheme with float buffers and
/// constant lobes.
enum class Settings { published, constant_lobes };

const char* title(Settings settings) {
  return settings == Settings::published ? "--preset paper, as published"
                                         : "buffers of floats, lobes as constants in the kernel";
}

/// A pass of the table.
struct TablePass {
  Pass pass;
  const char* title;
  bool per_cascade;
};
constexpr TablePass kTablePasses[] = {{Pass::inject_light, "injection", true},
                                      {Pass::inject_geometry, "geometry volume", true},
                                      {Pass::propagate, "propagation", true},
                                      {Pass::gather, "light buffer", false}};

/// Times of one basis [ms], and the status of a row that was not timed.
struct Times {
  std::optional<double> published, measured;
  std::string status = "-";
};

/// Rows of one part of the table.
using Section = std::vector<const Row*>;

/// A row that --filter left out has its published time.
Times times_of(const Section& section, Pass pass, std::optional<int> cascade, bool shadows,
               const std::string& basis) {
  for (const Row* row : section) {
    if (row->stage != name_of(pass) || row->problem.cascade != cascade ||
        row->problem.options.basis != basis)
      continue;
    const bool timed = row->status == Status::ok;
    return {row->published_ms, timed ? std::optional(row->times.median) : std::nullopt,
            std::string(name_of(row->status))};
  }
  return {published_ms(pass, basis, shadows, cascade), std::nullopt};
}

std::string cell(const std::optional<double>& value, int digits,
                 const std::string& otherwise = "-") {
  constexpr int kWidth = 9;
  return value ? fmt::format("{:>{}.{}f}", *value, kWidth, digits)
               : fmt::format("{:>{}.8}", otherwise, kWidth);
}

std::optional<double> ratio(const std::optional<double>& a, const std::optional<double>& b) {
  return a && b && *b > 0 ? std::optional(*a / *b) : std::nullopt;
}

/// A line of the table: times of each basis, then their ratios to the first basis.
std::string line_text(const std::string& title, const std::vector<Times>& columns) {
  std::string text = fmt::format("{:<24}", title);
  for (const Times& times : columns)
    text += cell(times.published, 3) + cell(times.measured, 2, times.status);
  for (std::size_t b = 1; b < columns.size(); ++b) {
    text += cell(ratio(columns[b].published, columns[0].published), 2) +
            cell(ratio(columns[b].measured, columns[0].measured), 2);
  }
  return text + "\n";
}

std::string head(const std::vector<std::string>& bases) {
  std::string first = fmt::format("{:<24}", "[ms]"), second = fmt::format("{:<24}", "");
  for (const std::string& basis : bases) first += fmt::format("{:>18}", basis);
  for (std::size_t b = 1; b < bases.size(); ++b)
    first += fmt::format("{:>18}", bases[b] + "/" + bases[0]);
  for (std::size_t b = 1; b < 2 * bases.size(); ++b)
    second += fmt::format("{:>9}{:>9}", "paper", "clpv");
  return first + "\n" + second + "\n";
}

/// Adds times. A sum is empty if a term is.
void add(Times& sum, const Times& times) {
  const auto plus = [](std::optional<double>& a, const std::optional<double>& b) {
    a = a && b ? std::optional(*a + *b) : std::nullopt;
  };
  plus(sum.published, times.published);
  plus(sum.measured, times.measured);
}

std::string section_text(const Section& section, Settings settings, bool shadows,
                         const std::vector<std::string>& bases, int cascades) {
  std::string text =
      fmt::format("\n{}, {} indirect shadows\n", title(settings), shadows ? "with" : "without");
  std::vector<Times> sums(bases.size(), {0.0, 0.0}), with_geometry = sums;
  for (const TablePass& pass : kTablePasses) {
    if (pass.pass == Pass::inject_geometry && !shadows) continue;
    for (int cascade = 0; cascade < (pass.per_cascade ? cascades : 1); ++cascade) {
      std::vector<Times> columns;
      for (std::size_t b = 0; b < bases.size(); ++b) {
        columns.push_back(times_of(section, pass.pass,
                                   pass.per_cascade ? std::optional(cascade) : std::nullopt,
                                   shadows, bases[b]));
        add(with_geometry[b], columns.back());
        if (pass.pass != Pass::inject_geometry) add(sums[b], columns.back());
      }
      const bool named = pass.per_cascade && cascade < static_cast<int>(std::size(kSizes));
      text += line_text(named ? fmt::format("{}, {}", pass.title, kSizes[cascade]) : pass.title,
                        columns);
    }
  }
  text += line_text("sum", sums);
  return shadows ? text + line_text("with geometry volume", with_geometry) : text;
}

std::string table1_table(const std::vector<Row>& rows) {
  std::vector<std::string> bases;
  int cascades = 0;
  std::map<std::pair<Settings, bool>, Section> sections;  // by settings, and lack of shadows
  for (const Row& row : rows) {
    const RenderOptions& o = row.problem.options;
    if (std::count(bases.begin(), bases.end(), o.basis) == 0) bases.push_back(o.basis);
    cascades = std::max(cascades, row.problem.cascade.value_or(-1) + 1);
    sections[{o.lobe_time == LobeTime::kernel ? Settings::published : Settings::constant_lobes,
              !o.blocked()}]
        .push_back(&row);
  }
  std::string text = head(bases);
  for (const auto& [key, section] : sections)
    text += section_text(section, key.first, !key.second, bases, cascades);
  return text + "\npaper: Table 1, on a Radeon HD 6870; clpv: medians on this device.\n";
}

Problem problem_of(const SuiteOptions& options, Settings settings, const std::string& basis) {
  Problem problem = basis_problem(options, basis);
  if (settings == Settings::published) problem.options = published_options(options.settings, basis);
  return problem;
}

Group cases(const std::shared_ptr<Bench>& bench, const SuiteOptions& options, Settings settings,
            bool shadows) {
  Group cases;
  for (const StageJob& job : {kInjectLight, kInjectGeometry, kPropagate, kGather}) {
    if (job.pass == Pass::inject_geometry && !shadows) continue;
    const bool all_cascades = job.stage == Stage::gather;
    for (int cascade = 0; cascade < (all_cascades ? 1 : options.settings.cascades); ++cascade) {
      for (const std::string& basis : bases_of(options)) {
        Problem problem = problem_of(options, settings, basis);
        problem.options.blockers = blockers_if(shadows);
        if (!all_cascades) problem.cascade = cascade;
        Case added = stage_case(bench, "table1", job, problem);
        added.row.published_ms = published_ms(job.pass, basis, shadows, problem.cascade);
        cases.push_back(std::move(added));
      }
    }
  }
  return cases;
}

}  // namespace

Suite table1_suite() {
  return {"table1",
          "the paper's Table 1, published and measured: injection and propagation of each cascade, "
          "light buffer, ratios to sh2",
          [](Session& session, const SuiteOptions& options) {
            std::vector<Group> groups;
            for (const Settings settings : {Settings::published, Settings::constant_lobes}) {
              const auto bench =
                  make_bench(session, options, problem_of(options, settings, kFirstBasis).options);
              for (const bool shadows : {true, false})
                groups.push_back(cases(bench, options, settings, shadows));
            }
            return groups;
          },
          table1_table};
}

}  // namespace clpv::bench
