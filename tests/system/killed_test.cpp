// SPDX-License-Identifier: MIT
// Runs ended from outside. Killed, they leave complete files or none, and the next run is right.
// Interrupted, they report which results exist.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <fstream>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <thread>

#include "image/image_io.hpp"
#include "support/interrupt.hpp"
#include "tests/support/run_program.hpp"
#include "tests/support/scenes.hpp"

namespace clpv::test::killed_test {
namespace {

namespace fs = std::filesystem;
using namespace std::chrono_literals;
using Clock = std::chrono::steady_clock;
using ::testing::HasSubstr;
using ::testing::IsSupersetOf;

/// A process in a separate group, so that a signal reaches it and its children.
class Child {
 public:
  Child(const std::string& command, const fs::path& said) {
    pid_ = ::fork();
    if (pid_ != 0) return;
    ::setpgid(0, 0);
    // A shell ignores SIGINT for tests that it starts in the background.
    for (const int signal : {SIGINT, SIGTERM, SIGHUP}) ::signal(signal, SIG_DFL);
    sigset_t all;  // a parent may block them
    ::sigfillset(&all);
    ::sigprocmask(SIG_SETMASK, &all, nullptr);
    ::execl("/bin/sh", "sh", "-c", ("exec " + command + " >/dev/null 2>" + said.string()).c_str(),
            nullptr);
    ::_exit(127);
  }
  ~Child() {
    if (pid_ > 0) end(SIGKILL);
  }
  Child(const Child&) = delete;
  Child& operator=(const Child&) = delete;

  bool running() const { return ::waitpid(pid_, &status_, WNOHANG) == 0; }
  /// The exit code, or 128 + the signal that ended it.
  int end(int signal) {
    ::kill(pid_, signal);
    ::waitpid(pid_, &status_, 0);
    pid_ = -1;
    return WIFEXITED(status_) ? WEXITSTATUS(status_) : 128 + WTERMSIG(status_);
  }

 private:
  pid_t pid_ = -1;
  mutable int status_ = 0;
};

struct Killed : ::testing::Test {
  TemporaryFolder folder_;
};

/// Long enough to be met at work: frames without end.
std::string sequence(const fs::path& folder, int frames = 1000) {
  return "sequence " CLPV_SOURCE_DIR "/scenes/atrium_living.json --frames " +
         std::to_string(frames) + " --fps 24" + kSmallSteps + "-o " + folder.string();
}

/// Numbers of the frames in a folder, and of those with a line in its times.jsonl.
std::set<int> frames_in(const fs::path& folder) {
  std::set<int> found;
  for (const auto& entry : fs::directory_iterator(folder))
    if (const std::string name = entry.path().filename().string(); name.starts_with("frame-"))
      found.insert(std::stoi(name.substr(6)));
  return found;
}
std::set<int> frames_with_times(const fs::path& folder) {
  std::set<int> found;
  std::ifstream in(folder / "times.jsonl");
  for (std::string line; std::getline(in, line);)
    if (const auto json = nlohmann::json::parse(line, nullptr, false);
        json.is_object() && json.contains("frame"))
      found.insert(json["frame"].get<int>());
  return found;
}

TEST_F(Killed, EachFrameOfAKilledSequenceHasItsTimes) {
  const fs::path film = folder_ / "film";
  int frames = 0;
  {
    Child child(CLPV_PROGRAM " " + sequence(film), folder_ / "said");
    for (int i = 0; i < 6000 && !fs::exists(film / "frame-0007.exr"); ++i)
      std::this_thread::sleep_for(10ms);
    ASSERT_EQ(child.end(SIGKILL), 128 + SIGKILL) << read_file(folder_ / "said");
    EXPECT_THAT(frames_with_times(film), IsSupersetOf(frames_in(film)));
    frames = static_cast<int>(frames_in(film).size()) + 2;
  }
  // Two processes resume it at once.
  const std::string command = CLPV_PROGRAM " " + sequence(film, frames);
  const Outcome both = run("( " + command + " ) & " + command + "; code=$?; wait $! && exit $code");
  ASSERT_EQ(both.exit_code, 0) << both.err;
  std::ifstream in(film / "times.jsonl");
  nlohmann::json last;
  for (std::string line; std::getline(in, line);) last = nlohmann::json::parse(line);
  EXPECT_EQ(last["summary"]["frames"], frames);
}

TEST_F(Killed, AnInterruptIsReported) {
  for (const int signal : {SIGINT, SIGTERM}) {
    const fs::path film = folder_ / ("film" + std::to_string(signal)), said = folder_ / "said";
    Child child(CLPV_PROGRAM " " + sequence(film), said);
    for (int i = 0; i < 600 && !fs::exists(film / "frame-0001.exr"); ++i)
      std::this_thread::sleep_for(100ms);
    ASSERT_TRUE(child.running()) << read_file(said);
    EXPECT_EQ(child.end(signal), 128 + signal);
    EXPECT_THAT(read_file(said), HasSubstr("clpv: interrupted; "));
    EXPECT_THAT(read_file(said),
                HasSubstr(" of 1000; the same command resumes in " + film.string()));
    EXPECT_THAT(frames_with_times(film), IsSupersetOf(frames_in(film)));
    for (const auto& entry : fs::directory_iterator(film)) {
      EXPECT_FALSE(entry.path().filename().string().starts_with(".")) << entry.path();
      if (entry.path().extension() == ".exr") {
        EXPECT_NO_THROW(read_image(entry.path()));
      }
    }
  }
}

// `bake` once worked on for minutes.
TEST(Interrupt, WorkThatNeverAsksIsEnded) {
  const auto work = [] {
    ::signal(SIGINT, SIG_DFL);
    catch_interrupts();
    ::raise(SIGALRM);  // without an interrupt: nothing
    ::raise(SIGINT);
    {
      const Uninterruptible compilation("this test");
      ::raise(SIGALRM);
      fmt::print(stderr, "still at work");
    }
    if (::alarm(0) > 0) ::raise(SIGALRM);  // as the kernel does in a while
  };
  EXPECT_EXIT(work(), ::testing::KilledBySignal(SIGINT),
              ::testing::AllOf(HasSubstr("still at work"), HasSubstr("within a long step")));
}

}  // namespace
}  // namespace clpv::test::killed_test
