// SPDX-License-Identifier: MIT
#include "codegen/gather_source.hpp"

#include <fmt/format.h>

#include "basis/kernel_text.hpp"
#include "codegen/linear_code.hpp"

namespace clpv {
namespace {

/// CLPV_EACH_PAIR; the last of an odd number is paired with zero. `member`: expression for a lane of a member.
std::string pair_macros(int count, const std::string& member) {
  std::string text = "#define CLPV_NONE(a) 0.0f\n", each = "#define CLPV_EACH_PAIR(DO)";
  for (int i = 0; i < count; ++i)
    text += fmt::format("#define CLPV_C{}(a) {}\n", i, fmt::format(fmt::runtime(member), i));
  for (int i = 0; i < count; i += 2) {
    const std::string odd = i + 1 < count ? fmt::format("CLPV_C{}", i + 1) : "CLPV_NONE";
    each += fmt::format(" DO({}, CLPV_C{}, {})", i / 2, i, odd);
  }
  return text + each + "\n";
}

/// g(n): alpha(-n), or 4 b(-n).
std::string gather_weights(int count, TransportKind transport, bool from_table) {
  std::string text = "CLPV_INLINE Coefficients gather_weights(const float3 n CLPV_AND_TABLE) {\n";
  if (!has_faces(transport)) return text + "  return cosine_integrals(-n.x, -n.y, -n.z);\n}\n";
  text += fmt::format("  Coefficients g = {};\n", from_table
                                                      ? "table_basis(-n.x, -n.y, -n.z CLPV_PASS_TABLE)"
                                                      : "basis_functions(-n.x, -n.y, -n.z)");
  for (int i = 0; i < count; ++i) text += fmt::format("  g.c{} *= 4.0f;\n", i);
  return text + "  return g;\n}\n";
}

}  // namespace

int packed_pairs(const Basis& basis) {
  return (basis.size() + 1) / 2;
}

std::string pack_source(const Basis& basis) {
  return coefficient_macros(basis.size()) + pair_macros(basis.size(), "(((const float*)&(a).c{})[lane])");
}

std::string radiance_source(const Basis& basis) {
  return coefficient_macros(basis.size(), "float") + pair_macros(basis.size(), "(a).c{}") +
         basis.kernel_source();
}

std::string gather_source(const Basis& basis, TransportKind transport, const LobeOptions& lobes,
                          bool from_table) {
  std::string text = radiance_source(basis);
  if (from_table) text += table_basis_source(basis, lobes.table_size);
  return text + gather_weights(basis.size(), transport, from_table);
}

}  // namespace clpv
