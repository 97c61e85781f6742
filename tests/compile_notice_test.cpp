// SPDX-License-Identifier: MIT
// What is said of a long wait for the compiler: once, and only of a long one.
#include "device/compile_notice.hpp"

#include <gtest/gtest.h>
#include <spdlog/sinks/ostream_sink.h>

#include <sstream>

#include "support/log.hpp"

namespace clpv::compile_notice_test {
namespace {

/// The log, in place of stderr, while this lives.
class LogInMemory {
 public:
  LogInMemory() : before_(spdlog::default_logger()) {
    auto logger =
        std::make_shared<spdlog::logger>("test", std::make_shared<spdlog::sinks::ostream_sink_mt>(text_));
    logger->set_pattern("%v");
    spdlog::set_default_logger(logger);
  }
  ~LogInMemory() { spdlog::set_default_logger(before_); }

  std::string text() const { return text_.str(); }

 private:
  std::ostringstream text_;
  std::shared_ptr<spdlog::logger> before_;
};

TEST(CompileNotice, AShortWaitIsNotTold) {
  const LogInMemory log;
  tell_of_compiling("this device", 0, 600);
  tell_of_keeping(600);
  EXPECT_EQ(log.text(), "");
}

TEST(CompileNotice, ALongWaitIsToldOnce) {
  const LogInMemory log;
  tell_of_compiling("this device", 600, 1200);
  tell_of_compiling("this device", 1200, 6000);
  EXPECT_EQ(log.text(), "compiling kernels for this device, which takes a while the first time\n");
}

TEST(CompileNotice, AfterALongWaitKeepingIsTold) {
  const LogInMemory log;
  tell_of_keeping(1200);
  EXPECT_EQ(log.text(), "keeping the compiled kernels for later starts\n");
}

}  // namespace
}  // namespace clpv::compile_notice_test
