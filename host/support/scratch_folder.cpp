// SPDX-License-Identifier: MIT
#include "support/scratch_folder.hpp"

#include <cerrno>
#include <cstdlib>
#include <system_error>

#include "support/error.hpp"

namespace clpv {

namespace fs = std::filesystem;

ScratchFolder::ScratchFolder() {
  const char* given = std::getenv("TMPDIR");
  const fs::path above = fs::absolute(given != nullptr && *given != '\0' ? given : "/tmp");
  std::string name = (above / ".clpv-run-XXXXXX").string();
  if (::mkdtemp(name.data()) == nullptr) {
    throw Error(ExitCode::run_time,
                "TMPDIR: found '{}' ({}); allowed: a folder that can be written", above.string(),
                std::generic_category().message(errno));
  }
  path_ = name;
}

ScratchFolder::~ScratchFolder() {
  std::error_code ignored;
  fs::remove_all(path_, ignored);
}

}  // namespace clpv
