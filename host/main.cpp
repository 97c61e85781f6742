// SPDX-License-Identifier: MIT
#include "cli/program_main.hpp"

int main(int argc, char** argv) {
  return clpv::program_main(argc, argv);
}
