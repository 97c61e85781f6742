// SPDX-License-Identifier: MIT
#include "additions.hpp"
#include "cli/commands.hpp"

int main(int argc, char** argv) {
  return clpv::program_main(argc, argv, clpv::lab_additions());
}
