// SPDX-License-Identifier: MIT
#include "cli/commands.hpp"

int main(int argc, char** argv) {
  return clpv::program_main(argc, argv);
}
