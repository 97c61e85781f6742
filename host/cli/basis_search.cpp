// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <vector>

#include "cli/basis_parts.hpp"
#include "cli/options.hpp"
#include "support/output_file.hpp"
#include "support/progress.hpp"

namespace clpv {
namespace {

constexpr const char* kNamedSets[] = {"srbf4", "srbf8v1", "srbf8v2", "srbf8v3", "srbf14", "sh2", "sh3"};

LobeAims aims_of(const BasisSearchOptions& options) {
  if (!options.weights.empty()) return load_aims(options.weights);
  return options.over == SearchedCosines::axes ? propagation_axes() : all_directions();
}

std::string name_of(const BasisSearchOptions& options) {
  return options.output.empty() ? fmt::format("searched{}", *options.centres)
                                : std::filesystem::path(options.output).stem().string();
}

/// Writes the format that load_basis reads.
nlohmann::json file_of(const Basis& basis) {
  nlohmann::json file{{"name", basis.name()}, {"centres", nlohmann::json::array()}};
  if (basis.lambda() != 0) {
    file["lambda"] = basis.lambda();
  } else {
    file["lambda"] = basis.lambdas();
  }
  for (const glm::dvec3& xi : basis.centres()) file["centres"].push_back({xi.x, xi.y, xi.z});
  return file;
}

nlohmann::json described(const Basis& basis, const BasisView& view, const LobeAims& aims) {
  nlohmann::json description = describe(basis, view);
  description["error_over"] = error_over(basis, aims);
  return description;
}

/// The found set, and the named sets for comparison.
nlohmann::json with_named_sets(const Basis& found, double lambda, const BasisView& view,
                               const LobeAims& aims) {
  nlohmann::json bases = nlohmann::json::array({described(found, view, aims)});
  for (const char* name : kNamedSets) bases.push_back(described(*make_basis(name, lambda), view, aims));
  return bases;
}

}  // namespace

void add_search_options(CLI::App& command, BasisSearchOptions& options) {
  CLI::Option* search =
      add(command, "--search", "N", options.centres,
          "number of centres of a set to search for, with minimum clamped-cosine error; the same seed gives "
          "the same set")
          ->excludes("name")
          ->excludes("--centres");
  command.add_option("--seed", options.search.seed, "seed of the random starts of a search")
      ->needs(search)
      ->capture_default_str();
  command.add_option("--starts", options.search.starts, "number of starts of a search")
      ->needs(search)
      ->check(CLI::Range(1, 100000))
      ->capture_default_str();
  CLI::Option* over =
      add_choice(command, "--over", options.over,
                 "directions of the clamped cosines: all directions equally, or the six axes");
  over->needs(search);
  add(command, "--weights", "FILE", options.weights,
      "directions with weights, as JSON from clpv render --dump-normals")
      ->needs(search)
      ->excludes(over);
  add_choice(command, "--lambdas", options.search.lambdas,
             "lambdas that the search optimises: none, one for all centres, or one per centre")
      ->needs(search);
  command
      .add_option("--max-condition", options.search.max_condition,
                  "maximum condition number of the Gram matrix of a search result")
      ->needs(search)
      ->capture_default_str();
  add(command, "-o,--output", "FILE.json", options.output, "output file of the found set")->needs(search);
}

void print_search(const BasisSearchOptions& options, double lambda, const BasisView& view, bool json) {
  if (!options.output.empty()) check_writable(options.output);
  CentreSearch search = options.search;
  search.centres = *options.centres;
  search.aims = aims_of(options);
  search.lambda = lambda;
  Progress progress("search", search.starts);
  const CentreSearchResult found = search_centres(search, [&] { progress.advance(); });
  const auto basis = make_basis_from_centres(name_of(options), found.set.centres, found.set.lambdas);
  if (!options.output.empty()) write_file(options.output, file_of(*basis).dump(1) + "\n");
  const nlohmann::json bases = with_named_sets(*basis, lambda, view, search.aims);
  if (json) {
    const nlohmann::json of_search{{"centres", search.centres},
                                   {"over", search.aims.name},
                                   {"lambdas", name_of(search.lambdas)},
                                   {"max_condition", search.max_condition},
                                   {"starts", search.starts},
                                   {"valid", found.valid},
                                   {"seed", search.seed},
                                   {"error", found.error},
                                   {"error_bound", minimum_error(search.centres)}};
    fmt::print("{}\n", nlohmann::json{{"schema", 1}, {"search", of_search}, {"bases", bases}}.dump(2));
    return;
  }
  fmt::print(
      "{}\nobjective: root mean square of the relative L2 error over {}; {} of {} starts ended within the "
      "bounds.\n"
      "Minimum over all directions of any {} functions: {:.4f}.\n",
      table_of(bases), search.aims.name, found.valid, search.starts, search.centres,
      minimum_error(search.centres));
  for (std::size_t i = 0; i < basis->centres().size(); ++i) {
    const glm::dvec3& xi = basis->centres()[i];
    fmt::print("{:9.6f} {:9.6f} {:9.6f}  lambda {:.6f}\n", xi.x, xi.y, xi.z, basis->lambdas()[i]);
  }
}

}  // namespace clpv
