// SPDX-License-Identifier: MIT
#include "parallel/ranks.hpp"

#include <dlfcn.h>
#include <sched.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <thread>

#include "device/device.hpp"
#include "support/log.hpp"

namespace clpv {
namespace {

constexpr const char* kModule = "clpv_mpi.so";  // found by the program's RUNPATH

class Alone : public Communicator {
 public:
  int rank() const override { return 0; }
  int size() const override { return 1; }
  int local_rank() const override { return 0; }
  int local_size() const override { return 1; }
  std::string host() const override { return "this machine"; }
  void sum(double*, std::size_t) override {}
  std::vector<std::string> gather(const std::string& mine) override { return {mine}; }
  void broadcast(std::string&) override {}
  [[noreturn]] void abort(int code) override { std::_Exit(code); }
};

/// All of the machine's where the process is bound to none.
int bound_processors() {
  cpu_set_t bound;
  if (::sched_getaffinity(0, sizeof bound, &bound) == 0) return CPU_COUNT(&bound);
  return static_cast<int>(std::max(1u, std::thread::hardware_concurrency()));
}

/// The part of a device for one of several ranks that share it.
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

Ranks::Ranks() : Ranks(std::make_unique<Alone>()) {}

std::string Ranks::name() const {
  return fmt::format("rank {} on {}", rank(), communicator_->host());
}

int Ranks::processors() const {
  const int bound = bound_processors(), there = static_cast<int>(::sysconf(_SC_NPROCESSORS_ONLN));
  return bound < there ? bound : std::max(1, there / communicator_->local_size());
}

Device Ranks::device(const std::string& choice) const {
  if (alone()) return choose_device(choice);
  const std::vector<Device> devices = choose_devices(choice);
  const auto local_rank = static_cast<std::size_t>(communicator_->local_rank()),
             local_size = static_cast<std::size_t>(communicator_->local_size()), count = devices.size();
  const std::size_t sharing = (local_size - local_rank % count + count - 1) / count;
  Device device = devices[local_rank % count];
  if (sharing > 1)
    device = share_of(device, static_cast<unsigned>(sharing), static_cast<unsigned>(local_rank / count));
  spdlog::info("{} of {}: {} ({}), compute units: {}", name(), size(), device.name, device.platform,
               device.compute_units);
  if (device.type == "cpu" && bound_processors() < static_cast<int>(device.compute_units)) {
    spdlog::warn(
        "{} is bound to fewer processors than its device has: mpirun --bind-to none lets it take all",
        name());
  }
  return device;
}

std::string Ranks::from_root(const std::function<std::string()>& make) {
  std::string text;
  if (is_root()) text = make();
  communicator_->broadcast(text);
  return text;
}

Ranks& alone() {
  static Ranks team;
  return team;
}

std::optional<Launched> launched() {
  for (const auto& [rank, size] : {std::pair{"OMPI_COMM_WORLD_RANK", "OMPI_COMM_WORLD_SIZE"},
                                   {"PMI_RANK", "PMI_SIZE"},
                                   {"PMIX_RANK", "SLURM_STEP_NUM_TASKS"}}) {
    const char *my_rank = std::getenv(rank), *ranks = std::getenv(size);
    if (my_rank == nullptr) continue;
    const Launched found{std::atoi(my_rank), ranks ? std::optional(std::atoi(ranks)) : std::nullopt};
    return found.size == 1 ? std::nullopt : std::optional(found);
  }
  return std::nullopt;
}

std::unique_ptr<Communicator> start_mpi() {
  // MPI's own modules look for its symbols among the global ones.
  void* module = ::dlopen(kModule, RTLD_NOW | RTLD_GLOBAL);
  if (module == nullptr) {
    throw Error(ExitCode::run_time,
                "started as one of several processes, but without MPI: {}; build with CLPV_MPI where MPI is "
                "(Debian: libopenmpi-dev)",
                ::dlerror());
  }
  const auto make = reinterpret_cast<MakeCommunicator*>(::dlsym(module, kMakeCommunicator));
  if (make == nullptr) throw Error(ExitCode::run_time, "{}: {}", kModule, ::dlerror());
  return std::unique_ptr<Communicator>(make());
}

}  // namespace clpv
