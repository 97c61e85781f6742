// SPDX-License-Identifier: MIT
// Parses, calls a command, turns an error into an exit code; nothing else.
#include <CL/opencl.hpp>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <iostream>

#include "commands/commands.hpp"
#include "device/cl_error.hpp"
#include "support/error.hpp"
#include "support/interrupt.hpp"

namespace {

/// What stdout did not take is lost: a full disk, say.
void flush_data() {
  if (std::fflush(stdout) != 0 || !std::cout.flush())
    throw clpv::Error(clpv::ExitCode::run_time, "stdout: cannot be written: {}", std::strerror(errno));
}

}  // namespace

int main(int argc, char** argv) {
  using namespace clpv;
  CLI::App app;
  Shared shared;
  add_commands(app, shared);
  if (argc == 1) {
    std::cout << app.help();
    return 0;
  }
  catch_interrupts();
  try {
    parse_command_line(app, argc, argv);
    flush_data();
  } catch (const CLI::ParseError& error) {
    return app.exit(error, std::cout, std::cerr) == 0 ? 0 : static_cast<int>(ExitCode::usage);
  } catch (const Error& error) {
    std::cerr << "clpv: " << error.what() << '\n';
    return static_cast<int>(error.code());
  } catch (const Interrupted& interrupted) {
    std::cerr << "clpv: interrupted; " << interrupted.what() << std::endl;
    end_as_interrupted();
  } catch (const cl::Error& error) {
    const Error named = cl_error(error);
    std::cerr << "clpv: " << named.what() << '\n';
    return static_cast<int>(named.code());
  } catch (const std::bad_alloc&) {
    std::cerr << "clpv: out of memory\n";
    return static_cast<int>(ExitCode::run_time);
  } catch (const std::exception& error) {
    std::cerr << "clpv: " << error.what() << '\n';
    return static_cast<int>(ExitCode::run_time);
  }
  return 0;
}
