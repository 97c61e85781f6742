// SPDX-License-Identifier: MIT
// main() of clpv, without the parser's headers, which take five seconds to compile.
#pragma once

namespace clpv {

struct Additions;

/// Sets up signals and helper processes, then run_program() (cli/commands.hpp).
int program_main(int argc, char** argv);
int program_main(int argc, char** argv, const Additions& additions);

}  // namespace clpv
