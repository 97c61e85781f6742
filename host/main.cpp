// SPDX-License-Identifier: MIT
// Parses, calls a command, turns an error into an exit code; nothing else.
#include <cerrno>
#include <chrono>
#include <cstdio>
#include <cstring>
#include <iostream>
#include <thread>

#include "commands/commands.hpp"
#include "parallel/failure.hpp"
#include "parallel/launched.hpp"
#include "parallel/team.hpp"
#include "support/error.hpp"
#include "support/interrupt.hpp"

namespace {

using namespace clpv;

/// What stdout did not take is lost: a full disk, say.
void flush_data() {
  if (std::fflush(stdout) != 0 || !std::cout.flush())
    throw Error(ExitCode::run_time, "stdout: cannot be written: {}", std::strerror(errno));
}

/// Of several processes, those but the first: what all of them find out is not for them to tell.
bool one_of_many() {
  const std::optional<Launched> started = launched();
  return started && started->rank > 0;
}

/// Leaves to rank 0 to say why. A launcher ends all as soon as one process has failed: not before that one has spoken.
int ended_unheard(int code) {
  if (code != 0) std::this_thread::sleep_for(std::chrono::milliseconds(500));
  return code;
}

int ended(ExitCode code, const std::string& words) {
  std::cerr << "clpv: " << words << '\n';
  return static_cast<int>(code);
}

/// Of the exception being handled, of which the others of a team know nothing: they must not wait for this one.
int ended_alone(const Shared& shared) {
  const Failure failure = current_failure();
  if (one_of_many() && !shared.begun) return ended_unheard(static_cast<int>(failure.code));
  const bool with_others = shared.begun && !shared.begun->alone();
  ended(failure.code, with_others ? shared.begun->name() + ": " + failure.words : failure.words);
  if (with_others) shared.begun->abort(failure.code);
  return static_cast<int>(failure.code);
}

int run(CLI::App& app, Shared& shared, int argc, char** argv) {
  try {
    parse_command_line(app, argc, argv);
    flush_data();
    return 0;
  } catch (const CLI::ParseError& error) {
    const int usage = error.get_exit_code() == 0 ? 0 : static_cast<int>(ExitCode::usage);
    if (one_of_many()) return ended_unheard(usage);
    app.exit(error, std::cout, std::cerr);
    return usage;
  } catch (const TeamFailure& failure) {
    return one_of_many() ? static_cast<int>(failure.code()) : ended(failure.code(), failure.what());
  } catch (const Interrupted& interrupted) {
    if (!one_of_many()) std::cerr << "clpv: interrupted; " << interrupted.what() << std::endl;
    end_as_interrupted();
  } catch (...) {
    return ended_alone(shared);
  }
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app;
  Shared shared;
  add_commands(app, shared);
  if (argc == 1) {
    std::cout << app.help();
    return 0;
  }
  catch_interrupts();
  return run(app, shared, argc, argv);  // the team ends with `shared`
}
