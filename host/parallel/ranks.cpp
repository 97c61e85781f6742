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

/// Communicator of one process, without MPI.
class SingleProcess : public Communicator {
 public:
  int rank() const override { return 0; }
  int size() const override { return 1; }
  int local_rank() const override { return 0; }
  int local_size() const override { return 1; }
  std::string host() const override { return "this machine"; }
  void sum(double*, std::size_t) override {}
  std::vector<std::string> gather(const std::string& text) override { return {text}; }
  void broadcast(std::string&) override {}
  [[noreturn]] void abort(int code) override { std::_Exit(code); }
};

/// Number of processors that the process is bound to; all of the machine's if it is not bound.
int bound_processors() {
  cpu_set_t bound;
  if (::sched_getaffinity(0, sizeof bound, &bound) == 0) return CPU_COUNT(&bound);
  return static_cast<int>(std::max(1u, std::thread::hardware_concurrency()));
}

/// Sub-device for the `index`-th of `ranks` ranks that share a device; the whole device if it
/// cannot be split.
Device share_of(const Device& device, unsigned ranks, unsigned index) {
  const unsigned units = std::max(1u, device.compute_units / ranks);
  // If fewer than ranks, some share one.
  const unsigned count = std::max(1u, device.compute_units / units);
  try {
    return sub_device(device, units, index % count);
  } catch (const Error& error) {
    log_debug("{}; {} ranks share it", error.what(), ranks);
    return device;
  }
}

}  // namespace

Ranks::Ranks() : Ranks(std::make_unique<SingleProcess>()) {}

std::string Ranks::name() const {
  return fmt::format("rank {} on {}", rank(), communicator_->host());
}

int Ranks::processors() const {
  const int bound = bound_processors(), online = static_cast<int>(::sysconf(_SC_NPROCESSORS_ONLN));
  return bound < online ? bound : std::max(1, online / communicator_->local_size());
}

Device Ranks::device(const std::string& choice) const {
  if (alone()) return choose_device(choice);
  const std::vector<Device> devices = choose_devices(choice);
  const auto local_rank = static_cast<std::size_t>(communicator_->local_rank()),
             local_size = static_cast<std::size_t>(communicator_->local_size()),
             count = devices.size();
  const std::size_t sharing = (local_size - local_rank % count + count - 1) / count;
  Device device = devices[local_rank % count];
  if (sharing > 1)
    device =
        share_of(device, static_cast<unsigned>(sharing), static_cast<unsigned>(local_rank / count));
  log_info("{} of {}: {} ({}), compute units: {}", name(), size(), device.name, device.platform,
           device.compute_units);
  if (device.type == "cpu" && bound_processors() < static_cast<int>(device.compute_units)) {
    log_warning(
        "{} is bound to fewer processors than its device has: mpirun --bind-to none allows it all "
        "of them",
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

Ranks& single_rank() {
  static Ranks ranks;
  return ranks;
}

std::optional<LauncherRank> launcher_rank() {
  for (const auto& [rank, size] : {std::pair{"OMPI_COMM_WORLD_RANK", "OMPI_COMM_WORLD_SIZE"},
                                   {"PMI_RANK", "PMI_SIZE"},
                                   {"PMIX_RANK", "SLURM_STEP_NUM_TASKS"}}) {
    const char *rank_text = std::getenv(rank), *size_text = std::getenv(size);
    if (rank_text == nullptr) continue;
    const LauncherRank found{std::atoi(rank_text),
                             size_text ? std::optional(std::atoi(size_text)) : std::nullopt};
    return found.size == 1 ? std::nullopt : std::optional(found);
  }
  return std::nullopt;
}

std::unique_ptr<Communicator> start_mpi() {
  // RTLD_GLOBAL: MPI's plug-ins look up MPI's symbols among the global ones.
  void* module = ::dlopen(kModule, RTLD_NOW | RTLD_GLOBAL);
  if (module == nullptr) {
    throw Error(ExitCode::run_time,
                "started as one of several processes, but built without MPI: {}; install MPI "
                "(Debian: libopenmpi-dev) and build with CLPV_MPI",
                ::dlerror());
  }
  const auto make = reinterpret_cast<MakeCommunicator*>(::dlsym(module, kMakeCommunicator));
  if (make == nullptr) throw Error(ExitCode::run_time, "{}: {}", kModule, ::dlerror());
  return std::unique_ptr<Communicator>(make());
}

}  // namespace clpv
