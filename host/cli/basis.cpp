// SPDX-License-Identifier: MIT
// clpv basis: properties of each basis: conditioning, clamped-cosine error and energy conservation.

#include <fmt/format.h>

#include <cmath>
#include <memory>
#include <nlohmann/json.hpp>
#include <vector>

#include "basis/bases.hpp"
#include "basis/lobe_quality.hpp"
#include "basis/rotated_lobe.hpp"
#include "cli/commands.hpp"
#include "cli/options.hpp"
#include "support/error.hpp"
#include "support/log.hpp"

namespace clpv {

namespace basis_command {

struct Options {
  std::string name, centres_file, axis = "0,0,1";
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
  add_format(*command, options->format);
  command->callback([options] { run(*options); });
}

}  // namespace clpv
