// SPDX-License-Identifier: MIT
// Another program, run beside this one.
#pragma once

#include <sys/types.h>

#include <cstddef>
#include <cstdio>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace clpv {

class Process {
 public:
  struct Ended {
    int code = -1;     ///< 128 + signal where one ended it; -1: could not be started
    std::string said;  ///< on stdout and stderr
  };

  /// Starts it, without a shell; looked up in the path where its name has no '/'. `fed`: it reads what feed() gives it; else it has nothing to read.
  Process(const std::string& program, const std::vector<std::string>& arguments, bool fed = false);
  ~Process();  ///< ends the input, and waits
  Process(const Process&) = delete;
  Process& operator=(const Process&) = delete;

  /// Waits where it reads slowly. False: it reads no more; end() tells why.
  bool feed(std::span<const std::byte> bytes);

  /// Ends its input, and waits for it.
  Ended end();

 private:
  struct Close {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };
  std::unique_ptr<std::FILE, Close> said_;  ///< a file without a name
  int input_ = -1;
  pid_t child_ = -1;
  int failed_ = 0;  ///< errno of starting it
};

}  // namespace clpv
