// SPDX-License-Identifier: MIT
#include "pipeline/tuning.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "clpv/version.hpp"
#include "options/render_options.hpp"
#include "support/error.hpp"
#include "support/fingerprint.hpp"
#include "support/input_file.hpp"
#include "support/json_schema.hpp"
#include "support/log.hpp"
#include "support/named_enum.hpp"
#include "support/output_file.hpp"
#include "volume/volume_format.hpp"

namespace clpv {
namespace {

constexpr double kWidestGroup = 4096;  // work-items along an axis; devices refuse more than they have anyway

/// Everything a tuning depends on, this version of the kernels included.
std::string key_of(const Device& device, const TuningSubject& s) {
  return fmt::format("{}\n{}\n{}\n{}\n{}\npropagate {} {} {} {} {} {}", device.platform,
                     device.platform_version, device.name, device.driver, version(), s.basis,
                     name_of(s.transport), name_of(s.state), s.grid, name_of(s.storage),
                     s.layout ? name_of(*s.layout) : std::string_view());
}

void require_sound(const nlohmann::json& entry, const std::string& file) {
  const std::vector<Rule> rules = {rule::object(""),
                                   rule::integer("/schema", 1, 1).must(),
                                   rule::text("/key").must(),
                                   rule::text("/layout", names_of<Layout>()).must(),
                                   rule::choice("/lanes", {1, 8}).must(),
                                   rule::list("/local", 2, 2).must(),
                                   rule::integer("/local/*", 1, kWidestGroup)};
  check_rules(entry, rules, file);
}

}  // namespace

TuningSubject tuning_subject(const RenderOptions& options, bool any_layout) {
  return {options.basis, options.transport, options.state,
          options.grid,  options.storage,   any_layout ? std::nullopt : std::optional(options.layout)};
}

std::optional<TuningCache> TuningCache::of_user() {
  if (const auto folder = user_cache_folder()) return TuningCache(*folder);
  return std::nullopt;
}

std::filesystem::path TuningCache::file_of(const Device& device, const TuningSubject& subject) const {
  return folder_ / (Fingerprint().add(key_of(device, subject)).hex() + ".tuning");
}

std::optional<Tuning> TuningCache::load(const Device& device, const TuningSubject& subject) const {
  const std::filesystem::path file = file_of(device, subject);
  const auto kept = file_bytes(file);
  if (!kept) return std::nullopt;
  const nlohmann::json entry = nlohmann::json::parse(*kept, nullptr, false);
  try {
    if (entry.is_discarded()) throw Error(ExitCode::bad_input, "{}: not JSON", file.string());
    require_sound(entry, file.string());
  } catch (const Error& error) {
    spdlog::warn("tuning ignored: {}; clpv tune makes it anew", error.what());
    return std::nullopt;
  }
  if (entry.at("key") != key_of(device, subject)) return std::nullopt;
  return Tuning{{entry.at("local")[0], entry.at("local")[1]},
                entry.at("lanes"),
                named<Layout>("layout", entry.at("layout").get<std::string>())};
}

void TuningCache::store(const Device& device, const TuningSubject& subject, const Tuning& tuning) const {
  const std::filesystem::path file = file_of(device, subject);
  std::error_code failed;
  std::filesystem::create_directories(folder_, failed);
  if (failed) throw Error(ExitCode::run_time, "{}: {}", folder_.string(), failed.message());
  const nlohmann::json entry = {{"schema", 1},
                                {"key", key_of(device, subject)},
                                {"layout", name_of(tuning.layout)},
                                {"lanes", tuning.lanes},
                                {"local", tuning.local}};
  write_file(file, entry.dump(2) + "\n");
}

Tuning tuning_for(const Device& device, RenderOptions& options, bool choose_layout) {
  const auto cache = TuningCache::of_user();
  if (!cache) return {};
  if (choose_layout) {
    if (const auto best = cache->load(device, tuning_subject(options, true))) options.layout = best->layout;
  }
  const auto tuning = cache->load(device, tuning_subject(options));
  if (!tuning) {
    spdlog::debug("propagation of {} is not tuned for {}", options.basis, device.name);
    return {};
  }
  spdlog::debug("tuned: layout {}, {} cells a work-item, work-groups of {} x {}", name_of(tuning->layout),
                tuning->lanes, tuning->local[0], tuning->local[1]);
  return *tuning;
}

}  // namespace clpv
