// SPDX-License-Identifier: MIT
#include "verify/capsules.hpp"

#include <algorithm>
#include <cctype>
#include <map>
#include <system_error>

#include "clpv/version.hpp"
#include "device/recorder.hpp"
#include "support/error.hpp"
#include "support/input_file.hpp"
#include "support/output_file.hpp"

namespace clpv::detail {
const std::map<std::string, std::string_view>& embedded_replay_files();
}

namespace clpv::verify {
namespace {

namespace fs = std::filesystem;

/// "propagate-sh2-sampled-blockers"
std::string file_name(const Case& c) {
  std::string name = fmt::format("{}-{}", name_of(c.stage), c.name);
  std::ranges::replace_if(
      name, [](unsigned char l) { return std::isalnum(l) == 0 && l != '.'; }, '-');
  return name;
}

std::string words_of(const CheckResults& results) {
  std::string words;
  for (const CheckResult& r : results) {
    if (!words.empty()) words += "; ";
    words += fmt::format("{}: {}", r.variant, name_of(r.status));
    if (r.status == Status::ok || r.status == Status::wrong)
      words += fmt::format(", {:.3g} of {:.3g} allowed", r.deviation.worst, r.deviation.allowed);
    if (r.status == Status::wrong) words += " at " + r.deviation.place;
    if (!r.reason.empty()) words += ", " + r.reason.substr(0, r.reason.find('\n'));
  }
  return words;
}

std::size_t commands(const std::string& text, const std::string& command) {
  std::size_t count = 0;
  for (std::size_t at = 0; (at = text.find("\n" + command, at)) != std::string::npos; ++at) ++count;
  return count;
}

std::string readme(const Case& c, const Device& device, const CheckResults& checked,
                   const CheckResults& recorded, const std::string& capsule) {
  const std::size_t launches = commands(capsule, "launch "), outputs = commands(capsule, "expect ");
  std::string text =
      fmt::format("# A capsule of clpv {}: {} {}\n\n", version(), name_of(c.stage), c.name);
  text += fmt::format("Device: {} ({}), driver {}, {}, {} lanes\n", device.name, device.platform,
                      device.driver, device.version, device.lanes);
  text += fmt::format("Result: {}\n", words_of(checked));
  text += fmt::format("Result while it was recorded: {}\n", words_of(recorded));
  text += fmt::format("{} programs, {} launches, {} outputs compared{}\n\n",
                      commands(capsule, "program "), launches, outputs,
                      outputs > 0 ? "" : ": the process ended, or was ended, before");
  text += "`make check` builds replay.c, which needs only OpenCL 1.2, and replays capsule.txt.\n";
  text += "`make check DEVICE=TEXT` takes a device whose \"PLATFORM: DEVICE\" has that text.\n";
  text +=
      "It ends with 0 (ok), 1 (wrong or failed) or 77 (unsupported). Expected values are those\n";
  text += "of clpv's reference in double precision. License of all files: MIT.\n";
  return text;
}

}  // namespace

Capsules::Capsules(fs::path folder) : folder_(std::move(folder)) {
  std::error_code error;
  fs::create_directories(folder_, error);
  if (error)
    throw Error(ExitCode::run_time, "--capsules {}: {}", folder_.string(), error.message());
  if (!fs::is_empty(folder_, error) || error)
    throw Error(ExitCode::usage, "--capsules {}: found files; allowed: a new or empty folder",
                folder_.string());
}

Capsules::~Capsules() {
  std::error_code ignored;
  for (const fs::path& folder : incomplete_) fs::remove_all(folder, ignored);
}

fs::path Capsules::recording_of(const fs::path& folder, const Case& c) {
  return folder / ("." + file_name(c) + ".part");
}

void Capsules::begin(const Case& recorded) {
  const fs::path folder = recording_of(folder_, recorded);
  std::error_code error;
  fs::create_directory(folder, error);
  if (error) throw Error(ExitCode::run_time, "{}: {}", folder.string(), error.message());
  incomplete_.insert(folder);
}

fs::path Capsules::finish(const Case& c, const Device& device, const CheckResults& checked,
                          const CheckResults& recorded) {
  const fs::path part = recording_of(folder_, c), whole = folder_ / file_name(c);
  for (const CheckResult& result : recorded)
    if (result.reason.starts_with(Recorder::kRecording))
      throw Error(ExitCode::run_time, "{}: {}", whole.string(), result.reason);
  const std::string capsule = file_bytes(part / "capsule.txt").value_or("");
  write_file(part / "README.md", readme(c, device, checked, recorded, capsule));
  for (const auto& [name, text] : detail::embedded_replay_files()) write_file(part / name, text);
  std::error_code error;
  fs::rename(part, whole, error);
  if (error) throw Error(ExitCode::run_time, "{}: {}", whole.string(), error.message());
  incomplete_.erase(part);
  return whole;
}

}  // namespace clpv::verify
