// SPDX-License-Identifier: MIT
#include "cli/commands.hpp"
#include "support/interrupt.hpp"

int main(int argc, char** argv) {
  clpv::catch_interrupts();
  return clpv::run_program(argc, argv);
}
