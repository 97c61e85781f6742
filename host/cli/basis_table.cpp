// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <vector>

#include "basis/lobe_quality.hpp"
#include "cli/basis_parts.hpp"

namespace clpv {

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

std::string table_of(const nlohmann::json& bases) {
  const bool aimed = !bases.empty() && bases.front().contains("error_over");
  std::string text =
      fmt::format("{:10} {:>3} {:>6} {:>9} {:>8} {:>8} {:>8} {:>7} {:>7} {:>9} {:>9} {:>8} {:>8}{}\n",
                  "basis", "N", "lambda", "condition", "L2 error", "mean L2", "minimum", "flux", "peak",
                  "sampled 8", "sampled24", "exact 8", "exact 24", aimed ? "    aimed" : "");
  for (const nlohmann::json& b : bases) {
    const auto number = [&](const char* key) { return b.at(key).get<double>(); };
    const bool several = number("lambda") == 0 && !b.at("lambdas").empty();
    text += fmt::format(
        "{:10} {:3} {:>6} {:9.4g} {:8.3f} {:8.3f} {:8.3f} {:7.4f} {:6.2f}d {:9.3f} {:9.3f} {:8.3f} {:8.3f}",
        b.at("name").get<std::string>(), b.at("n").get<int>(),
        several ? "each" : fmt::format("{:.4g}", number("lambda")), number("condition"),
        number("relative_l2"), number("mean_relative_l2"), number("minimum"), number("flux"),
        number("peak_error_degrees"), number("energy_sampled_8"), number("energy_sampled_24"),
        number("energy_exact_8"), number("energy_exact_24"));
    text += aimed ? fmt::format(" {:8.4f}\n", number("error_over")) : "\n";
  }
  return text;
}

}  // namespace clpv
