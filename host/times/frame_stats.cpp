// SPDX-License-Identifier: MIT
#include "times/frame_stats.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "support/statistics.hpp"

namespace clpv {
std::array<double, 3> volume_energy(Session& session, const Basis& basis, const Volume& volume) {
  const std::vector<float> values = volume.read(session);
  const auto plane = values.size() / 3 / static_cast<std::size_t>(basis.size());
  std::array<double, 3> energy{};
  for (std::size_t channel = 0; channel < 3; ++channel) {
    for (std::size_t i = 0; i < basis.integrals().size(); ++i) {
      double sum = 0;
      for (std::size_t p = 0; p < plane; ++p)
        sum += values[(channel * basis.integrals().size() + i) * plane + p];
      energy[channel] += sum * basis.integrals()[i];
    }
  }
  return energy;
}

void FrameStats::end_startup() {
  startup_ms_ = since_mark();
  mark_ = Clock::now();
}

void FrameStats::end_first_frame(Session& session) {
  session.queue().finish();
  first_frame_ms_ = since_mark();
}

void FrameStats::add_energy(Session& session, const Frame& frame, const CascadeVolumes& volumes) {
  const auto energy = [&](const Volume& volume, const Basis& basis) {
    std::array<double, 3> stored = volume_energy(session, basis, volume);
    for (double& watts : stored) watts /= volumes.light_scale;
    return stored;
  };
  // Sort finest first, independent of the order of computation.
  energies_.insert(energies_.begin(), {volumes.cascade, energy(volumes.injected, frame.basis()),
                                       energy(volumes.accumulated, frame.gathered())});
}

nlohmann::json FrameStats::to_json(const Session& session, const nlohmann::json& options) const {
  nlohmann::json energy = nlohmann::json::array();
  for (const Energy& e : energies_) {
    energy.push_back(
        {{"cascade", e.cascade}, {"injected", e.injected}, {"accumulated", e.accumulated}});
  }
  const auto samples = [&](const auto& part) {
    std::vector<double> values;
    for (const FrameCost& cost : times_.costs()) values.push_back(part(cost));
    return values;
  };
  std::vector<TimeRecord> times = {
      time_record("frame", samples([](const FrameCost& cost) { return cost.wall_ms; })),
      time_record("host", samples([](const FrameCost& cost) { return cost.host.host_ms; }))};
  const auto of_host = [&](auto HostWork::*part) {
    return median(samples([&](const FrameCost& cost) { return cost.host.*part; }));
  };
  nlohmann::json kernels = nlohmann::json::array();
  for (const KernelTime& time : times_.kernels()) {
    kernels.push_back({{"stage", name_of(time_record(time.mark, {time.ms}))},
                       {"kernel", time.kernel},
                       {"launches", time.launches},
                       {"items", time.items},
                       {"chain", time.chain},
                       {"ms", time.ms}});
  }
  const double frame_ms = times[0].median;
  std::ranges::move(times_.stage_records(), std::back_inserter(times));
  return {{"schema", 2},
          {"device", clpv::to_json(session.device())},
          {"options", options},
          {"times", times},
          {"kernels", kernels},
          {"timer", times_.from_events() ? "event" : "wall"},
          {"launches", of_host(&HostWork::launches)},
          {"fills", of_host(&HostWork::fills)},
          {"waits", of_host(&HostWork::waits)},
          {"arguments", of_host(&HostWork::arguments)},
          {"written_bytes", of_host(&HostWork::written)},
          {"host_ms",
           {{"culling", of_host(&HostWork::culling_ms)},
            {"arguments", of_host(&HostWork::arguments_ms)},
            {"enqueueing", of_host(&HostWork::enqueueing_ms)},
            {"waiting", of_host(&HostWork::waited_ms)}}},
          {"first_launch_ms", std::max(0.0, first_frame_ms_ - frame_ms)},
          {"build_ms", session.programs().build_ms()},
          {"startup_ms", startup_ms_},
          {"device_bytes", session.peak_device_bytes()},
          {"energy", energy}};
}

}  // namespace clpv
