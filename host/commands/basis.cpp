// clpv basis: what each basis is, how well it holds a clamped cosine, how it keeps energy.
#include <fmt/format.h>

#include <cmath>
#include <memory>
#include <nlohmann/json.hpp>
#include <vector>

#include "basis/lobe_quality.hpp"
#include "basis/rotated_lobe.hpp"
#include "commands/basis_figures.hpp"
#include "commands/choices.hpp"
#include "commands/commands.hpp"
#include "commands/parse.hpp"
#include "support/error.hpp"

namespace clpv {
namespace {

struct Options {
  std::string name, centres_file, axis = "0,0,1", figures;
  double lambda = kDefaultLambda;
  LobeOptions lobes;
  bool json = false;
};

glm::dvec3 unit_axis(const std::string& text) {
  const glm::dvec3 axis = parse_dvec3(text, "--axis");
  const double length = std::hypot(axis.x, axis.y, axis.z);
  if (!(length > 0) || !std::isfinite(length))
    throw Error(ExitCode::usage, "--axis: '{}' has length {}; allowed: a vector other than 0", text, length);
  return axis / length;
}

nlohmann::json describe(const Basis& basis, const Options& options, const glm::dvec3& axis) {
  const LobeOptions& lobes = options.lobes;
  const std::vector<double> c = Lobes(basis, lobes)(axis);
  const LobeQuality quality = lobe_quality(basis, c, axis);
  const Transport sampled = make_transport(TransportKind::sampled, basis, lobes),
                  exact = make_transport(TransportKind::exact, basis, lobes);
  const auto energy = [&](const Transport& transport, int steps) {
    return energy_after(basis, std::get<FaceTransport>(transport.scheme), steps);
  };
  nlohmann::json centres = nlohmann::json::array();
  for (const glm::dvec3& xi : basis.centres()) centres.push_back({xi.x, xi.y, xi.z});
  return {{"name", basis.name()},
          {"n", basis.size()},
          {"lambda", basis.lambda()},
          {"lobe", name_of(lobes.kind)},
          {"centres", centres},
          {"condition", basis.condition()},
          {"axis", {axis.x, axis.y, axis.z}},
          {"coefficients", c},
          {"relative_l2", quality.relative_l2},
          {"mean_relative_l2", mean_relative_l2(basis, Lobes(basis, lobes))},
          {"minimum", quality.minimum},
          {"flux", quality.flux},
          {"peak_error_degrees", quality.peak_error_degrees},
          {"energy_sampled_8", energy(sampled, 8)},
          {"energy_sampled_24", energy(sampled, 24)},
          {"energy_exact_8", energy(exact, 8)},
          {"energy_exact_24", energy(exact, 24)}};
}

void print(const nlohmann::json& bases) {
  fmt::print("{:8} {:>3} {:>6} {:>9} {:>8} {:>8} {:>8} {:>7} {:>7} {:>9} {:>9} {:>8} {:>8}\n", "basis", "N",
             "lambda", "condition", "L2 error", "mean L2", "minimum", "flux", "peak", "sampled 8",
             "sampled24", "exact 8", "exact 24");
  for (const nlohmann::json& b : bases) {
    const auto number = [&](const char* key) { return b.at(key).get<double>(); };
    fmt::print(
        "{:8} {:3} {:6} {:9.4g} {:8.3f} {:8.3f} {:8.3f} {:7.4f} {:6.2f}d {:9.3f} {:9.3f} {:8.3f} {:8.3f}\n",
        b.at("name").get<std::string>(), b.at("n").get<int>(), number("lambda"), number("condition"),
        number("relative_l2"), number("mean_relative_l2"), number("minimum"), number("flux"),
        number("peak_error_degrees"), number("energy_sampled_8"), number("energy_sampled_24"),
        number("energy_exact_8"), number("energy_exact_24"));
  }
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

/// Of the bases that are named, or else of the paper's.
void write_figures(const Options& options) {
  const bool named = !options.name.empty() || !options.centres_file.empty();
  const BasisFigures figures{named ? bases_of(options) : paper_bases(options.lambda), options.lobes,
                             options.lambda};
  for (const auto& file : write_basis_figures(figures, options.figures)) fmt::print("{}\n", file.string());
}

void run(const Options& options) {
  if (!options.figures.empty()) return write_figures(options);
  const glm::dvec3 axis = unit_axis(options.axis);
  nlohmann::json bases = nlohmann::json::array();
  for (const auto& basis : bases_of(options)) bases.push_back(describe(*basis, options, axis));
  if (options.json) {
    fmt::print("{}\n", nlohmann::json{{"schema", 1}, {"bases", bases}}.dump(2));
  } else {
    print(bases);
  }
}

}  // namespace

void add_basis(CLI::App& app, Shared&) {
  CLI::App* command = app.add_subcommand(
      "basis", "Tell of each basis: conditioning, error of its clamped cosine, energy after 8 and 24 steps");
  auto options = std::make_shared<Options>();
  CLI::Option* name =
      command->add_option("name", options->name, "one basis; all, if not given")->type_name("NAME");
  command
      ->add_option("--centres", options->centres_file,
                   "an SRBF set of your own: JSON {\"name\": ..., \"centres\": [[x, y, z], ...]}")
      ->type_name("FILE")
      ->excludes(name);
  command->add_option("--lambda", options->lambda, "bandwidth of the SRBF kernels, between 0 and 1")
      ->capture_default_str();
  command->add_option("--axis", options->axis, "axis of the clamped cosine, any length")
      ->type_name("X,Y,Z")
      ->capture_default_str();
  add_choice(*command, "--lobe", options->lobes.kind,
             "clamped cosine: projected exactly, or along +z and rotated through a table");
  command->add_option("--table-size", options->lobes.table_size, "entries of the table of rotated lobes")
      ->capture_default_str();
  CLI::Option* json = command->add_flag("--json", options->json, "JSON on stdout");
  command
      ->add_option(
          "--figures", options->figures,
          "draw the paper's figures 2, 3 and 6 into this folder instead: kernels, and lobes as spherical "
          "plots")
      ->type_name("DIR")
      ->excludes(json);
  command->callback([options] { run(*options); });
}

}  // namespace clpv
