// SPDX-License-Identifier: MIT
#include "sequence/times_file.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <fstream>
#include <limits>
#include <nlohmann/json.hpp>
#include <system_error>

#include "scene/bounds.hpp"
#include "support/error.hpp"
#include "support/json_schema.hpp"

namespace clpv {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

constexpr std::string_view kHeader = "{\"kind\": \"clpv sequence times\", \"schema\": 1}\n";
constexpr std::size_t kMaxLine = 1 << 20;  // bytes; a stage takes 60
constexpr double kMaxStages = 1 << 14, kMaxCascade = 1000, kMaxLight = 1000000;

const std::vector<Rule>& line_rules() {
  constexpr double kMax = std::numeric_limits<double>::max();
  static const std::vector<Rule> rules = {
      rule::object(""),
      rule::integer("/frame", 0, std::numeric_limits<int>::max()).must(),
      rule::text("/key").must(),
      rule::text("/settings").must(),
      rule::number("/time", 0, bounds::kSeconds).must(),
      rule::flag("/first").must(),
      rule::number("/pose_ms", 0, kMax).must(),
      rule::number("/frame_ms", 0, kMax).must(),
      rule::number("/write_ms", 0, kMax).must(),
      rule::list("/stages", 0, kMaxStages).must(),
      rule::object("/stages/*"),
      rule::text("/stages/*/stage", names_of<Pass>()).must(),
      rule::integer("/stages/*/cascade", 0, kMaxCascade),
      rule::integer("/stages/*/light", 0, kMaxLight),
      rule::number("/stages/*/ms", 0, kMax).must(),
      rule::text("/stages/*/timer", {"event", "wall"}).must()};
  return rules;
}

[[noreturn]] void fail(const fs::path& path, const std::string& why) {
  throw Error(ExitCode::run_time, "{}: cannot be written: {}", path.string(), why);
}

std::string reason() {
  return std::generic_category().message(errno);
}

/// Exclusive among processes. Also makes each append at the end of the file on network file
/// systems; where there are no locks, O_APPEND has to do.
class Lock {
 public:
  explicit Lock(int descriptor) : descriptor_(descriptor) {
    while (::flock(descriptor_, LOCK_EX) != 0 && errno == EINTR) {
    }
  }
  ~Lock() { ::flock(descriptor_, LOCK_UN); }
  Lock(const Lock&) = delete;
  Lock& operator=(const Lock&) = delete;

 private:
  int descriptor_;
};

off_t size_of(int descriptor) {
  struct stat found {};
  return ::fstat(descriptor, &found) == 0 ? found.st_size : 0;
}

/// Calls action(start, line) for each line that ends; of a longer one than kMaxLine for its begin.
void for_each_line(const fs::path& path,
                   const std::function<void(std::uint64_t, const std::string&)>& action) {
  std::ifstream in(path, std::ios::binary);
  std::array<char, 1 << 16> block;
  std::string line;
  std::uint64_t start = 0, at = 0;
  while (in.read(block.data(), block.size()), in.gcount() > 0) {
    for (const char c : std::string_view(block.data(), static_cast<std::size_t>(in.gcount()))) {
      ++at;
      if (c == '\n') {
        action(start, line);
        line.clear();
        start = at;
      } else if (line.size() < kMaxLine) {
        line += c;
      }
    }
  }
}

}  // namespace

json to_json(const FrameLine& line) {
  json stages = json::array();
  for (const StageTime& time : line.stages) {
    json& stage = stages.emplace_back(json{{"stage", name_of(time.mark.pass)},
                                           {"ms", time.ms},
                                           {"timer", time.from_events ? "event" : "wall"}});
    if (time.mark.cascade) stage["cascade"] = *time.mark.cascade;
    if (time.mark.light) stage["light"] = *time.mark.light;
  }
  return {{"frame", line.frame},       {"key", line.key},           {"settings", line.settings},
          {"time", line.seconds},      {"first", line.first},       {"pose_ms", line.pose_ms},
          {"frame_ms", line.frame_ms}, {"write_ms", line.write_ms}, {"stages", std::move(stages)}};
}

std::optional<FrameLine> frame_line(const std::string& text) {
  try {
    const json line = parse_json(text, "line");
    check_rules(line, line_rules(), "line");
    FrameLine made{line["frame"],    line["key"],      line["settings"],
                   line["time"],     line["first"],    line["pose_ms"],
                   line["frame_ms"], line["write_ms"], {}};
    for (const json& stage : line["stages"]) {
      StageTime time{{named<Pass>("stage", stage["stage"].get<std::string>())},
                     stage["ms"],
                     stage["timer"] == "event"};
      if (stage.contains("cascade")) time.mark.cascade = stage["cascade"].get<int>();
      if (stage.contains("light")) time.mark.light = stage["light"].get<int>();
      made.stages.push_back(time);
    }
    return made;
  } catch (const Error&) {
    return std::nullopt;
  }
}

TimesFile::TimesFile(fs::path path) : path_(std::move(path)) {
  // O_NONBLOCK: opening a FIFO would wait for its other end.
  descriptor_ = ::open(path_.c_str(),
                       O_RDWR | O_CREAT | O_APPEND | O_NONBLOCK | O_NOFOLLOW | O_CLOEXEC, 0666);
  if (descriptor_ < 0) fail(path_, reason());
  try {
    begin();
  } catch (...) {
    ::close(descriptor_);
    throw;
  }
}

/// Writes the first line, or checks it.
void TimesFile::begin() {
  struct stat found {};
  if (::fstat(descriptor_, &found) != 0 || !S_ISREG(found.st_mode))
    fail(path_, "it is not a regular file");
  const Lock lock(descriptor_);
  if (size_of(descriptor_) == 0) return append_text(std::string(kHeader));
  std::string line(kHeader.size(), '\0');
  if (::pread(descriptor_, line.data(), line.size(), 0) == ssize_t(line.size()) && line == kHeader)
    return;
  throw Error(ExitCode::run_time,
              "{}: found a file that clpv did not write; allowed: one that begins with {}, or none",
              path_.string(), kHeader.substr(0, kHeader.size() - 1));
}

TimesFile::~TimesFile() {
  ::close(descriptor_);
}

void TimesFile::append(const json& line) {
  const Lock lock(descriptor_);
  append_text(line.dump() + "\n");
}

void TimesFile::append_text(std::string text) {
  const off_t size = size_of(descriptor_);
  if (char last = '\n'; size > 0 && ::pread(descriptor_, &last, 1, size - 1) == 1 && last != '\n')
    text.insert(0, 1, '\n');  // ends a line that a crash has torn
  ssize_t written = -1;
  while ((written = ::write(descriptor_, text.data(), text.size())) < 0 && errno == EINTR) {
  }
  if (written == ssize_t(text.size())) return;
  const std::string why = written < 0 ? reason() : std::generic_category().message(ENOSPC);
  if (written > 0) static_cast<void>(::ftruncate(descriptor_, size) == 0);
  fail(path_, why);
}

void TimesFile::read(const std::vector<std::string>& keys, const std::string& settings,
                     const std::function<void(const FrameLine&)>& action) const {
  std::vector<std::uint64_t> starts(keys.size(), 0);  // 0: none, since the header is there
  const auto chosen = [&](const std::optional<FrameLine>& line) {
    return line && std::size_t(line->frame) < keys.size() && line->settings == settings &&
           line->key == keys[std::size_t(line->frame)];
  };
  for_each_line(path_, [&](std::uint64_t start, const std::string& text) {
    if (const auto line = frame_line(text); chosen(line)) starts[std::size_t(line->frame)] = start;
  });
  std::ifstream in(path_, std::ios::binary);
  for (const std::uint64_t start : starts) {
    std::string text;
    if (start == 0 || !std::getline(in.seekg(static_cast<std::streamoff>(start)), text)) continue;
    if (const auto line = frame_line(text); chosen(line)) action(*line);
  }
}

}  // namespace clpv
