// SPDX-License-Identifier: MIT
#include "cli/commands.hpp"
#include "support/helpers.hpp"
#include "support/interrupt.hpp"

int main(int argc, char** argv) {
  clpv::catch_interrupts();
  clpv::set_helper_program("/proc/self/exe");
  return clpv::run_program(argc, argv);
}
