// SPDX-License-Identifier: MIT
#include "parallel/rank_device.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <vector>

#include "parallel/launched.hpp"
#include "support/log.hpp"

namespace clpv {
namespace {

Device share_of(const Device& device, unsigned ranks, unsigned index) {
  const unsigned units = std::max(1u, device.compute_units / ranks);
  const unsigned parts = std::max(1u, device.compute_units / units);  // fewer than ranks: some share one
  try {
    return part_of(device, units, index % parts);
  } catch (const Error& error) {
    spdlog::debug("{}; {} ranks share it", error.what(), ranks);
    return device;
  }
}

}  // namespace

Device device_of_rank(const Team& team, const std::string& choice) {
  if (team.alone()) return choose_device(choice);
  const std::vector<Device> devices = choose_devices(choice);
  const auto rank = static_cast<std::size_t>(team.local_rank()), count = devices.size();
  const auto sharing = (static_cast<std::size_t>(team.local_size()) - rank % count + count - 1) / count;
  const Device& device = devices[rank % count];
  return sharing == 1 ? device
                      : share_of(device, static_cast<unsigned>(sharing), static_cast<unsigned>(rank / count));
}

void tell_devices(Team& team, const Device& device) {
  if (!launched()) return;
  const std::string mine =
      fmt::format("{} ({}), compute units: {}", device.name, device.platform, device.compute_units);
  spdlog::debug("{}: device {}, {}", team.name(), device.index, mine);
  const int processors = team.bound_processors();
  const bool slowed = device.type == "cpu" && processors < static_cast<int>(device.compute_units);
  const std::vector<std::string> all = team.gather(mine), slow = team.gather(slowed ? "slow" : "");
  std::map<std::string, int> counts;
  for (const std::string& one : all) ++counts[one];
  for (const auto& [what, ranks] : counts) spdlog::info("{} of {} ranks: {}", ranks, all.size(), what);
  if (const auto ranks = slow.size() - static_cast<std::size_t>(std::ranges::count(slow, "")); ranks > 0) {
    spdlog::warn(
        "{} of {} ranks are bound to fewer processors than their device has: mpirun --bind-to none lets them "
        "take all",
        ranks, slow.size());
  }
}

}  // namespace clpv
