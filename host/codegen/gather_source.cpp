// SPDX-License-Identifier: MIT
#include "codegen/gather_source.hpp"

#include <fmt/format.h>

#include "basis/kernel_text.hpp"
#include "codegen/constants.hpp"

namespace clpv {

int packed_pairs(const Basis& basis) {
  return (basis.size() + 1) / 2;
}

std::string radiance_source(const Basis& basis) {
  return coefficient_text(basis.size(), "float") + basis.kernel_source();
}

std::string gather_source(const Basis& basis, TransportKind transport, const LobeOptions& lobes,
                          bool from_table) {
  std::string text = radiance_source(basis);
  if (from_table) text += table_basis_source(basis, lobes.table_size);
  return text + fmt::format("#define CLPV_FACE_TRANSPORT {}\n#define CLPV_FROM_TABLE {}\n",
                            has_faces(transport) ? 1 : 0, from_table ? 1 : 0);
}

}  // namespace clpv
