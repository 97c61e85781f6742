// SPDX-License-Identifier: MIT
// Communicator on MPI: a module that the program loads only if a launcher (mpirun, srun) started
// it.
#include <mpi.h>

#include <algorithm>
#include <cstdlib>
#include <limits>
#include <stdexcept>

#include "parallel/communicator.hpp"

namespace clpv {
namespace {

constexpr std::size_t kChunk = std::size_t{1}
                               << 24;  // elements per reduction, whose count is an int

int length_of(const std::string& text) {
  if (text.size() > std::numeric_limits<int>::max())
    throw std::length_error("MPI: more than 2 GiB in one message");
  return static_cast<int>(text.size());
}

class MpiCommunicator : public Communicator {
 public:
  MpiCommunicator() {
    int provided = 0;
    MPI_Init_thread(nullptr, nullptr, MPI_THREAD_FUNNELED, &provided);
    MPI_Comm_rank(MPI_COMM_WORLD, &rank_);
    MPI_Comm_size(MPI_COMM_WORLD, &size_);
    MPI_Comm local = MPI_COMM_NULL;
    MPI_Comm_split_type(MPI_COMM_WORLD, MPI_COMM_TYPE_SHARED, 0, MPI_INFO_NULL, &local);
    MPI_Comm_rank(local, &local_rank_);
    MPI_Comm_size(local, &local_size_);
    MPI_Comm_free(&local);
  }
  ~MpiCommunicator() override { MPI_Finalize(); }
  MpiCommunicator(const MpiCommunicator&) = delete;
  MpiCommunicator& operator=(const MpiCommunicator&) = delete;

  int rank() const override { return rank_; }
  int size() const override { return size_; }
  int local_rank() const override { return local_rank_; }
  int local_size() const override { return local_size_; }

  std::string host() const override {
    char name[MPI_MAX_PROCESSOR_NAME];
    int length = 0;
    MPI_Get_processor_name(name, &length);
    return {name, static_cast<std::size_t>(length)};
  }

  void sum(double* values, std::size_t count) override {
    for (std::size_t first = 0; first < count; first += kChunk) {
      const int elements = static_cast<int>(std::min(kChunk, count - first));
      MPI_Allreduce(MPI_IN_PLACE, values + first, elements, MPI_DOUBLE, MPI_SUM, MPI_COMM_WORLD);
    }
  }

  std::vector<std::string> gather(const std::string& text) override {
    const int length = length_of(text);
    std::vector<int> lengths(rank_ == 0 ? static_cast<std::size_t>(size_) : 0), starts;
    MPI_Gather(&length, 1, MPI_INT, lengths.data(), 1, MPI_INT, 0, MPI_COMM_WORLD);
    std::string all;
    for (const int each : lengths) {
      starts.push_back(length_of(all));
      all.resize(all.size() + static_cast<std::size_t>(each));
    }
    length_of(all);  // throws if MPI's int counts overflow
    MPI_Gatherv(text.data(), length, MPI_CHAR, all.data(), lengths.data(), starts.data(), MPI_CHAR,
                0, MPI_COMM_WORLD);
    std::vector<std::string> texts;
    for (std::size_t r = 0; r < lengths.size(); ++r)
      texts.push_back(
          all.substr(static_cast<std::size_t>(starts[r]), static_cast<std::size_t>(lengths[r])));
    return texts;
  }

  void broadcast(std::string& text) override {
    int length = length_of(text);
    MPI_Bcast(&length, 1, MPI_INT, 0, MPI_COMM_WORLD);
    text.resize(static_cast<std::size_t>(length));
    MPI_Bcast(text.data(), length, MPI_CHAR, 0, MPI_COMM_WORLD);
  }

  [[noreturn]] void abort(int code) override {
    MPI_Abort(MPI_COMM_WORLD, code);
    std::abort();
  }

 private:
  int rank_ = 0, size_ = 1, local_rank_ = 0, local_size_ = 1;
};

}  // namespace
}  // namespace clpv

extern "C" clpv::Communicator* clpv_make_communicator() {
  return new clpv::MpiCommunicator;
}
