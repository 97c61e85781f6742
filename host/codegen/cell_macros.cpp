// SPDX-License-Identifier: MIT
#include "codegen/cell_macros.hpp"

#include <fmt/format.h>

namespace clpv {

std::string cell_macros(const std::string& type, const std::string& each, int count) {
  std::string list, fields;
  for (int i = 0; i < count; ++i) {
    list += fmt::format(" DO({})", i);
    fields += fmt::format("{} c{}", i == 0 ? "" : ",", i);
  }
  return fmt::format("#define CLPV_EACH_{}(DO){}\ntypedef struct {{\n  CLPV_REAL{};\n}} {};\n", each, list,
                     fields, type);
}

std::string coefficient_macros(int coefficients) {
  // Inlined by the compiler's front end: left to later passes, structs would be passed in memory or in vector registers,
  // and work-items would no longer vectorise on CPU devices.
  return "#define CLPV_INLINE static inline __attribute__((always_inline))\n"
         "#ifndef CLPV_LANES\n#define CLPV_LANES 1\n#endif\n"
         "#if CLPV_LANES == 8\n#define CLPV_REAL float8\n#else\n#define CLPV_REAL float\n#endif\n" +
         fmt::format("#define CLPV_N {}\n", coefficients) +
         cell_macros("Coefficients", "COEFFICIENT", coefficients);
}

}  // namespace clpv
