// SPDX-License-Identifier: MIT
#include "codegen/sweep_source.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "basis/bounce.hpp"
#include "codegen/linear_code.hpp"
#include "codegen/transmittance_source.hpp"

namespace clpv {
namespace {

constexpr const char* kAxisNames = "XYZ";

std::string link_macros() {
  const LinkVolumes links = link_volumes();
  std::string text = fmt::format("#define CLPV_X_LINKS {}\n", links.across[0].size());
  int volume = 0;
  for (int axis = 0; axis < 3; ++axis) {
    text += fmt::format("#define CLPV_EACH_{}_LINK(DO)", kAxisNames[axis]);
    for (const int link : links.across[axis]) text += fmt::format(" DO({}, {})", volume++, link);
    text += "\n";
  }
  return text;
}

}  // namespace

std::string sweep_bin_macros() {
  const std::vector<SweepBin> bins = sweep_bins(1);
  std::string text =
      fmt::format("#define CLPV_X_BINS {}\n",
                  std::count_if(bins.begin(), bins.end(), [](const SweepBin& bin) { return bin.axis == 0; }));
  for (int axis = 0; axis < 3; ++axis) {
    text += fmt::format("#define CLPV_EACH_{}_BIN(DO)", kAxisNames[axis]);
    for (std::size_t b = 0; b < bins.size(); ++b) {
      if (bins[b].axis == axis) text += fmt::format(" DO({})", b);
    }
    text += "\n";
  }
  return text;
}

std::string sweep_links_text(const Basis& basis, const Transport& transport) {
  return transmittance_source(basis, transport).text + link_macros();
}

CountedText sweep_collect_text() {
  const Matrix projection = swept_projection();
  LinearCode code;
  const std::string function = code.function("Coefficients", "project_bins", "Bins", projection,
                                             mirrors_of(*make_basis("bins24")).list());
  return {coefficient_macros(projection.rows()) + sweep_bin_macros() +
              cell_macros("Bins", "BIN", kSweepBins) + function,
          code.operations()};
}

std::string incident_flux_text() {
  return cell_macros("FaceFluxes", "FACE_FLUX", kCellFaces) +
         LinearCode().function("FaceFluxes", "incident_flux", "Bins", incident_flux());
}

std::string bounce_source_text(const Basis& basis) {
  return coefficient_macros(basis.size()) + sweep_bin_macros() + cell_macros("Bins", "BIN", kSweepBins) +
         incident_flux_text() +
         LinearCode().function("Coefficients", "reflected_intensity", "FaceFluxes",
                               reflected_intensity(basis));
}

std::string scatter_source_text(double anisotropy) {
  return coefficient_macros(swept_basis()->size()) + sweep_bin_macros() +
         cell_macros("Bins", "BIN", kSweepBins) +
         LinearCode().function("Bins", "scatter_bins", "Bins", scattering_matrix(anisotropy),
                               mirrors_of(*make_basis("bins24")).list());
}

}  // namespace clpv
