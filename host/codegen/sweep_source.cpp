// SPDX-License-Identifier: MIT
#include "codegen/sweep_source.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "codegen/cell_macros.hpp"
#include "codegen/linear_code.hpp"
#include "codegen/mirrors.hpp"
#include "codegen/transmit_source.hpp"

namespace clpv {
namespace {

constexpr const char* kAxisNames = "XYZ";

std::string way_macros() {
  const SweepWays ways = sweep_way_volumes();
  std::string text = fmt::format("#define CLPV_X_WAYS {}\n", ways.across[0].size());
  int volume = 0;
  for (int axis = 0; axis < 3; ++axis) {
    text += fmt::format("#define CLPV_EACH_{}_WAY(DO)", kAxisNames[axis]);
    for (const int way : ways.across[axis]) text += fmt::format(" DO({}, {})", volume++, way);
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

CountedText sweep_source_text(const Basis& basis) {
  const Mirrors mirrors = mirrors_of(basis);
  LinearCode code;
  const std::vector<std::string> means =
      code.product(bin_means(basis), fields("a", basis.size()), {mirrors.all.begin(), mirrors.all.end()});
  std::string text =
      coefficient_macros(basis.size()) + sweep_bin_macros() + cell_macros("Swept", "SWEPT", kSweepBins) +
      "CLPV_INLINE Swept clpv_bin_means(const Coefficients a) {\n" + code.text() + "  Swept m;\n";
  for (std::size_t i = 0; i < means.size(); ++i) text += fmt::format("  m.c{} = {};\n", i, means[i]);
  return {text + "  return m;\n}\n", code.operations()};
}

std::string sweep_ways_text(const Basis& basis, const Transport& transport) {
  return transmit_source(basis, transport).text + way_macros();
}

CountedText sweep_collect_text() {
  const Matrix projection = swept_projection();
  const Mirrors mirrors = mirrors_of(*make_basis("bins24"));
  LinearCode code;
  const std::vector<std::string> harmonics =
      code.product(projection, fields("m", kSweepBins), {mirrors.all.begin(), mirrors.all.end()});
  std::string text =
      coefficient_macros(projection.rows()) + sweep_bin_macros() + cell_macros("Swept", "SWEPT", kSweepBins) +
      "CLPV_INLINE Coefficients clpv_projected(const Swept m) {\n" + code.text() + "  Coefficients c;\n";
  for (std::size_t i = 0; i < harmonics.size(); ++i) text += fmt::format("  c.c{} = {};\n", i, harmonics[i]);
  return {text + "  return c;\n}\n", code.operations()};
}

}  // namespace clpv
