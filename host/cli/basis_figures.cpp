// SPDX-License-Identifier: MIT
#include <array>
#include <cmath>
#include <functional>
#include <nlohmann/json.hpp>
#include <numbers>
#include <system_error>

#include "basis/lobe_quality.hpp"
#include "basis/srbf.hpp"
#include "cli/basis_parts.hpp"
#include "cli/drawing.hpp"
#include "cli/options.hpp"
#include "support/array_files.hpp"
#include "support/error.hpp"
#include "support/output_file.hpp"

namespace clpv {
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

}  // namespace

std::vector<fs::path> write_basis_figures(BasisFigures figures, const fs::path& folder) {
  if (figures.bases.empty()) {
    for (const char* name : kPaperBases) figures.bases.push_back(make_basis(name, figures.lambda));
  }
  const Drawing drawing("basis", "--figures");
  create_folder("--figures", folder);
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

}  // namespace clpv
