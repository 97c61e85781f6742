// SPDX-License-Identifier: MIT
#include <csignal>

#include "additions.hpp"
#include "cli/commands.hpp"
#include "support/helpers.hpp"
#include "support/interrupt.hpp"
#include "support/process.hpp"

int main(int argc, char** argv) {
  clpv::reset_inherited_state();
  clpv::keep_absolute_path_entries();
  clpv::catch_interrupts();
  std::signal(SIGXFSZ, SIG_IGN);  // a write beyond `ulimit -f` then fails with a reason
  clpv::set_helper_program("/proc/self/exe");
  return clpv::run_program(argc, argv, clpv::lab_additions());
}
