#include "commands/basis_figures.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <system_error>

#include "basis/lobe_quality.hpp"
#include "basis/srbf.hpp"
#include "image/contact_sheet.hpp"
#include "image/image_io.hpp"
#include "image/label.hpp"
#include "image/spherical_plot.hpp"
#include "support/error.hpp"
#include "support/log.hpp"
#include "support/output_file.hpp"

namespace clpv {
namespace {

namespace fs = std::filesystem;

constexpr const char* kPaperBases[] = {"sh2",     "sh3",     "sh4",     "sh5",   "srbf4",
                                       "srbf8v1", "srbf8v2", "srbf8v3", "srbf14"};
constexpr double kFigure2Lambda = 0.4;
constexpr int kFigure2Columns = 5, kFigure3Columns = 5;
constexpr double kRoom = 1.13;  // of a plot over the largest value in it: the axes stick out

/// Linear colours, neighbours far apart.
constexpr std::array<glm::vec3, 8> kPalette{{{0.80f, 0.08f, 0.06f},
                                             {0.06f, 0.30f, 0.70f},
                                             {0.90f, 0.45f, 0.02f},
                                             {0.05f, 0.45f, 0.20f},
                                             {0.55f, 0.10f, 0.45f},
                                             {0.04f, 0.50f, 0.55f},
                                             {0.75f, 0.62f, 0.05f},
                                             {0.30f, 0.14f, 0.06f}}};

struct NamedAxis {
  std::string name;
  glm::dvec3 direction;  ///< unit
};

std::vector<NamedAxis> main_axes() {
  return {{"+x", {1, 0, 0}},  {"-x", {-1, 0, 0}}, {"+y", {0, 1, 0}},
          {"-y", {0, -1, 0}}, {"+z", {0, 0, 1}},  {"-z", {0, 0, -1}}};
}

PlottedFunction kernel_about(const glm::dvec3& centre, double lambda, const glm::vec3& colour) {
  return {[=](const glm::dvec3& w) { return abel_poisson(glm::dot(w, centre), lambda); }, colour, colour};
}

ContactSheet figure2(double lambda) {
  const std::unique_ptr<Basis> basis = make_basis("srbf8v2", lambda);
  ContactSheet sheet{
      {"Figure 2: the Abel-Poisson kernel, and the eight functions of srbf8v2", "radius: the value"},
      kFigure2Columns,
      {}};
  const double peak = abel_poisson(1, kFigure2Lambda), eight_peak = abel_poisson(1, lambda) * kRoom;
  sheet.tiles.push_back(
      {draw({.functions = {kernel_about({0, 0, 1}, kFigure2Lambda, kPositiveColour)},
             .silhouette = {},
             .extent = peak * kRoom}),
       {fmt::format("lambda {}", kFigure2Lambda), fmt::format("{:.2f} at its peak", peak)}});
  SphericalPlot joint{.functions = {}, .silhouette = {}, .extent = eight_peak};
  std::vector<Tile> singles;
  for (std::size_t i = 0; i < basis->centres().size(); ++i) {
    joint.functions.push_back(kernel_about(basis->centres()[i], lambda, kPalette[i % kPalette.size()]));
    const glm::ivec3 corner(glm::sign(basis->centres()[i]));
    singles.push_back(
        {draw({.functions = {joint.functions.back()}, .silhouette = {}, .extent = eight_peak}),
         {fmt::format("b{} about", i + 1), fmt::format("({}, {}, {})", corner.x, corner.y, corner.z)}});
  }
  sheet.tiles.push_back({draw(joint), {fmt::format("all eight, lambda {}", lambda), "joint"}});
  std::ranges::move(singles, std::back_inserter(sheet.tiles));
  return sheet;
}

Tile original(const NamedAxis& axis) {
  const auto cosine = [d = axis.direction](const glm::dvec3& w) { return std::max(0.0, glm::dot(w, d)); };
  return {draw({.functions = {{cosine, kPositiveColour, kNegativeColour}}, .silhouette = {}}),
          {"max(0, cos), " + axis.name, ""}};
}

Tile lobe(const Basis& basis, const Lobes& lobes, const NamedAxis& axis) {
  const std::vector<double> c = lobes(axis.direction);
  const LobeQuality quality = lobe_quality(basis, c, axis.direction);
  const auto value = [&](const glm::dvec3& w) { return basis.value(c, w); };
  return {draw({.functions = {{value, kPositiveColour, kNegativeColour}},
                .silhouette = Silhouette{axis.direction / 2.0, 0.5}}),
          {fmt::format("{}, {}", basis.name(), axis.name),
           fmt::format("error {:.3f}, min {:.2f}", quality.relative_l2, quality.minimum)}};
}

std::vector<std::string> lobe_title(const std::string& what, const BasisFigures& figures) {
  const std::string way = figures.lobes.kind == LobeKind::exact
                              ? "each projected exactly"
                              : "SRBF: projected along +z, then rotated (the paper's way)";
  return {fmt::format("{}; lambda {}; {}", what, figures.lambda, way),
          "blue: f > 0; red: f < 0; dashed: the clamped cosine; error: relative L2"};
}

/// All bases for one axis after the other, each beginning a row.
ContactSheet figure3(const BasisFigures& figures) {
  ContactSheet sheet{lobe_title("Figure 3: the clamped cosine along two axes", figures), kFigure3Columns, {}};
  sheet.columns = std::min(kFigure3Columns, 1 + static_cast<int>(figures.bases.size()));
  for (const NamedAxis& axis :
       {NamedAxis{"+z", {0, 0, 1}}, NamedAxis{"(-2, 1, -3)", glm::normalize(glm::dvec3(-2, 1, -3))}}) {
    sheet.tiles.push_back(original(axis));
    for (const auto& basis : figures.bases)
      sheet.tiles.push_back(lobe(*basis, Lobes(*basis, figures.lobes), axis));
    while (static_cast<int>(sheet.tiles.size()) % sheet.columns != 0)
      sheet.tiles.push_back({draw({.functions = {}, .silhouette = {}}), {}});
  }
  return sheet;
}

/// A column an axis, a row a basis.
ContactSheet figure6(const BasisFigures& figures) {
  const std::vector<NamedAxis> axes = main_axes();
  ContactSheet sheet{lobe_title("Figure 6: the clamped cosine along the six main axes", figures),
                     static_cast<int>(axes.size()),
                     {}};
  for (const NamedAxis& axis : axes) sheet.tiles.push_back(original(axis));
  for (const auto& basis : figures.bases) {
    const Lobes lobes(*basis, figures.lobes);
    for (const NamedAxis& axis : axes) sheet.tiles.push_back(lobe(*basis, lobes, axis));
  }
  return sheet;
}

void create_folder(const fs::path& folder) {
  std::error_code failed;
  fs::create_directories(folder, failed);
  if (failed) throw Error(ExitCode::run_time, "--figures {}: {}", folder.string(), failed.message());
}

}  // namespace

std::vector<std::unique_ptr<Basis>> paper_bases(double lambda) {
  std::vector<std::unique_ptr<Basis>> bases;
  for (const char* name : kPaperBases) bases.push_back(make_basis(name, lambda));
  return bases;
}

std::vector<fs::path> write_basis_figures(const BasisFigures& figures, const fs::path& folder) {
  create_folder(folder);
  const std::vector<fs::path> files{folder / "figure2.png", folder / "figure3.png", folder / "figure6.png"};
  for (const fs::path& file : files) check_writable(file);
  if (!can_draw_labels()) {
    spdlog::warn("no font found ({}; folders in OPENIMAGEIO_FONTS are searched too): pictures without words",
                 fmt::join(label_fonts(), ", "));
  }
  write_png(files[0], compose(figure2(figures.lambda)));
  write_png(files[1], compose(figure3(figures)));
  write_png(files[2], compose(figure6(figures)));
  return files;
}

}  // namespace clpv
