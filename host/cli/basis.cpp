// SPDX-License-Identifier: MIT
// clpv basis: properties of each basis: conditioning, clamped-cosine error and energy conservation.

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <filesystem>
#include <functional>
#include <memory>
#include <nlohmann/json.hpp>
#include <numbers>
#include <system_error>
#include <vector>

#include "basis/bases.hpp"
#include "basis/lobe_quality.hpp"
#include "basis/rotated_lobe.hpp"
#include "cli/commands.hpp"
#include "cli/drawing.hpp"
#include "cli/options.hpp"
#include "support/array_files.hpp"
#include "support/error.hpp"
#include "support/log.hpp"
#include "support/output_file.hpp"

namespace clpv {

// Part of `clpv basis`: the paper's figures.

struct BasisFigures {
  std::vector<std::unique_ptr<Basis>> bases;  ///< bases of Figures 3 and 6; empty: the paper's
  LobeOptions lobes;
  double lambda = kDefaultLambda;  ///< bandwidth of the eight functions in Figure 2
};

namespace {

namespace fs = std::filesystem;

constexpr const char* kPaperBases[] = {"sh2",     "sh3",     "sh4",     "sh5",   "srbf4",
                                       "srbf8v1", "srbf8v2", "srbf8v3", "srbf14"};
constexpr double kFigure2Lambda = 0.4;
const std::array<glm::dvec3, 7> kAxes{
    {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}, {-2, 1, -3}}};
// length

/// Functions on the sphere, sampled on a grid: rows from +z to -z including poles, columns around z
/// from +x.
class Surfaces {
 public:
  // 1.5 degrees: finer details appear smooth.
  static constexpr std::size_t kRows = 121, kColumns = 240;

  void add(const std::function<double(const glm::dvec3&)>& f) {
    for (std::size_t i = 0; i < kRows; ++i) {
      const double theta = std::numbers::pi * static_cast<double>(i) / (kRows - 1);
      for (std::size_t j = 0; j < kColumns; ++j) {
        const double phi = 2 * std::numbers::pi * static_cast<double>(j) / kColumns;
        const glm::dvec3 w(std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi),
                           std::cos(theta));
        values_.push_back(static_cast<float>(f(w)));
      }
    }
  }
  void write(const fs::path& file) const {
    write_npy(file, values_, std::array{values_.size() / (kRows * kColumns), kRows, kColumns});
  }

 private:
  std::vector<float> values_;
};

nlohmann::json triple(const glm::dvec3& v) {
  return {v.x, v.y, v.z};
}

/// The single kernel, and the eight kernels of srbf8v2.
nlohmann::json add_kernels(Surfaces& surfaces, double lambda) {
  nlohmann::json rows = nlohmann::json::array();
  const auto add = [&](const glm::dvec3& centre, double bandwidth) {
    surfaces.add([&](const glm::dvec3& w) { return abel_poisson(glm::dot(w, centre), bandwidth); });
    rows.push_back({{"lambda", bandwidth}, {"centre", triple(centre)}});
  };
  add({0, 0, 1}, kFigure2Lambda);
  const std::unique_ptr<Basis> eight = make_basis("srbf8v2", lambda);
  for (const glm::dvec3& centre : eight->centres()) add(centre, lambda);
  return rows;
}

nlohmann::json add_lobes(Surfaces& surfaces, const BasisFigures& figures) {
  nlohmann::json rows = nlohmann::json::array();
  for (const auto& basis : figures.bases) {
    const Lobes lobes(*basis, figures.lobes);
    for (const glm::dvec3& along : kAxes) {
      const glm::dvec3 axis = glm::normalize(along);
      const std::vector<double> c = lobes(axis);
      surfaces.add([&](const glm::dvec3& w) { return basis->value(c, w); });
      const LobeQuality quality = lobe_quality(*basis, c, axis);
      rows.push_back({{"basis", basis->name()},
                      {"axis", triple(axis)},
                      {"relative_l2", quality.relative_l2},
                      {"minimum", quality.minimum}});
    }
  }
  return rows;
}

/// Draws with python/clpv/draw into `folder`, which is created if missing. Returns the paths of
///   figure2.png  the Poisson kernel with lambda 0.4; the eight functions of srbf8v2, joint and one
///                by one
///   figure3.png  the clamped cosine along +z and along (-2, 1, -3), and each basis's lobe for it
///   figure6.png  the same along the six main axes
/// Throws Error(run_time) if a file is not writable, or Python or a module is missing.
std::vector<fs::path> write_basis_figures(BasisFigures figures, const fs::path& folder) {
  if (figures.bases.empty()) {
    for (const char* name : kPaperBases) figures.bases.push_back(make_basis(name, figures.lambda));
  }
  const Drawing drawing("basis", "--figures");
  const OutputFolder created("--figures", folder);
  const std::vector<fs::path> files{folder / "figure2.png", folder / "figure3.png",
                                    folder / "figure6.png"};
  for (const fs::path& file : files) check_outputs({{"--figures", file, true}});
  Surfaces surfaces;
  nlohmann::json document{{"lambda", figures.lambda},
                          {"lobe", figures.lobes.kind == LobeKind::exact ? "exact" : "rotate"}};
  document["kernels"] = add_kernels(surfaces, figures.lambda);
  document["lobes"] = add_lobes(surfaces, figures);
  drawing.add("figures.json", document);
  surfaces.write(drawing.folder() / "surfaces.npy");
  drawing.draw(folder);
  return files;
}

}  // namespace

namespace basis_command {

struct Options {
  std::string name, centres_file, axis = "0,0,1", figures;
  double lambda = kDefaultLambda;
  LobeOptions lobes;
  std::string format;
};

glm::dvec3 unit_axis(const std::string& text) {
  const auto [x, y, z] = parse_vector(text, "--axis");
  const double length = std::hypot(x, y, z);
  if (!(length > 0) || !std::isfinite(length))
    throw Error(ExitCode::usage, "--axis: '{}' has length {}; allowed: a vector other than 0", text,
                length);
  return glm::dvec3(x, y, z) / length;
}

std::vector<std::unique_ptr<Basis>> bases_of(const Options& options) {
  std::vector<std::unique_ptr<Basis>> bases;
  if (!options.centres_file.empty()) {
    bases.push_back(load_basis(options.centres_file, options.lambda));
  } else if (!options.name.empty()) {
    bases.push_back(make_basis(options.name, options.lambda));
  } else {
    for (const std::string& name : basis_names()) bases.push_back(make_basis(name, options.lambda));
  }
  return bases;
}

/// Lobe method, and the axis of the reported lobe.
struct BasisView {
  LobeOptions lobes;
  glm::dvec3 axis;  ///< unit
};

/// Describes a basis as a JSON object.
nlohmann::json describe(const Basis& basis, const BasisView& view) {
  const Lobes lobes(basis, view.lobes);
  const std::vector<double> c = lobes(view.axis);
  const LobeQuality quality = lobe_quality(basis, c, view.axis);
  const Transport sampled = make_transport(TransportKind::sampled, basis, view.lobes),
                  exact = make_transport(TransportKind::exact, basis, view.lobes);
  const auto energy = [&](const Transport& transport, int steps) {
    return energy_after(basis, std::get<FaceTransport>(transport.scheme), steps);
  };
  nlohmann::json centres = nlohmann::json::array();
  for (const glm::dvec3& xi : basis.centres()) centres.push_back({xi.x, xi.y, xi.z});
  return {{"name", basis.name()},
          {"n", basis.size()},
          {"lambda", basis.lambda()},
          {"lambdas", basis.lambdas()},
          {"lobe", name_of(view.lobes.kind)},
          {"centres", centres},
          {"condition", basis.condition()},
          {"axis", {view.axis.x, view.axis.y, view.axis.z}},
          {"coefficients", c},
          {"relative_l2", quality.relative_l2},
          {"mean_relative_l2", mean_relative_l2(basis, lobes)},
          {"minimum", quality.minimum},
          {"flux", quality.flux},
          {"peak_error_degrees", quality.peak_error_degrees},
          {"energy_sampled_8", energy(sampled, 8)},
          {"energy_sampled_24", energy(sampled, 24)},
          {"energy_exact_8", energy(exact, 8)},
          {"energy_exact_24", energy(exact, 24)}};
}

/// Formats one line per object.
std::string table_of(const nlohmann::json& bases) {
  std::string text =
      fmt::format("{:10} {:>3} {:>6} {:>9} {:>8} {:>8} {:>8} {:>7} {:>7} {:>9} {:>9} {:>8} {:>8}\n",
                  "basis", "N", "lambda", "condition", "L2 error", "mean L2", "minimum", "flux",
                  "peak", "sampled 8", "sampled24", "exact 8", "exact 24");
  for (const nlohmann::json& b : bases) {
    const auto number = [&](const char* key) { return b.at(key).get<double>(); };
    const bool several = number("lambda") == 0 && !b.at("lambdas").empty();
    text += fmt::format(
        "{:10} {:3} {:>6} {:9.4g} {:8.3f} {:8.3f} {:8.3f} {:7.4f} {:6.2f}d {:9.3f} {:9.3f} {:8.3f} "
        "{:8.3f}\n",
        b.at("name").get<std::string>(), b.at("n").get<int>(),
        several ? "each" : fmt::format("{:.4g}", number("lambda")), number("condition"),
        number("relative_l2"), number("mean_relative_l2"), number("minimum"), number("flux"),
        number("peak_error_degrees"), number("energy_sampled_8"), number("energy_sampled_24"),
        number("energy_exact_8"), number("energy_exact_24"));
  }
  return text;
}

void run(const Options& options) {
  if (!options.figures.empty()) {
    BasisFigures figures{{}, options.lobes, options.lambda};
    if (!options.name.empty() || !options.centres_file.empty()) figures.bases = bases_of(options);
    for (const auto& file : write_basis_figures(std::move(figures), options.figures))
      print_data("{}\n", file.string());
    return;
  }
  const BasisView view{options.lobes, unit_axis(options.axis)};
  nlohmann::json bases = nlohmann::json::array();
  for (const auto& basis : bases_of(options)) bases.push_back(describe(*basis, view));
  if (options.format == "json") {
    print_json(nlohmann::json{{"schema", 1}, {"bases", bases}}.dump(2) + "\n");
  } else {
    print_text(table_of(bases));
  }
}

}  // namespace basis_command

void add_basis(CLI::App& app, Shared&) {
  using namespace basis_command;
  CLI::App* command = app.add_subcommand(
      "basis",
      "Report on each basis: conditioning, clamped-cosine error, energy after 8 and 24 steps");
  auto options = std::make_shared<basis_command::Options>();
  CLI::Option* name =
      add(*command, "name", "NAME", options->name, "name of one basis (default: all)");
  add(*command, "--centres", "FILE", options->centres_file,
      "custom SRBF set: JSON {\"name\": ..., \"lambda\": ..., \"centres\": [[x, y, z], ...]}; name "
      "and lambda (one number, or one per centre) are optional")
      ->excludes(name);
  add_number(*command, "--lambda", "X", options->lambda,
             "parameter of the SRBF kernels, between 0 and 1, narrower with larger values; a "
             "lambda in --centres overrides it",
             {0, 1});
  add(*command, "--axis", "X,Y,Z", options->axis, "axis of the clamped cosine, any length");
  add_choice(*command, "--lobe", options->lobes.kind,
             "method of the clamped cosine: exact projection, or projection along +z and rotation "
             "by a table");
  add_number(*command, "--table-size", "N", options->lobes.table_size,
             "number of entries in the table of rotated lobes; 0: without a table",
             {0, kMaxTableSize});
  CLI::Option* format = add_format(*command, options->format);
  add(*command, "--figures", "DIR", options->figures,
      "output folder for the paper's figures 2, 3 and 6, in place of the report")
      ->excludes(format);
  command->callback([options] { run(*options); });
}

}  // namespace clpv
