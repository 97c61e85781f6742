// SPDX-License-Identifier: MIT
#include "device/shared_programs.hpp"

#include <algorithm>
#include <map>
#include <mutex>

namespace clpv {
namespace {

constexpr std::size_t kKept = 256;  // programs of about ten sets of options

/// Contexts and programs of the process.
class SharedPrograms {
 public:
  cl::Context context_of(const cl::Device& device) {
    const std::scoped_lock lock(mutex_);
    cl::Context& context = contexts_[device()];
    if (context() == nullptr) context = cl::Context(device);
    return context;
  }
  cl::Program find(const cl::Context& context, const std::string& key) {
    const std::scoped_lock lock(mutex_);
    const auto found = programs_.find({context(), key});
    if (found == programs_.end()) return {};
    found->second.used = ++uses_;
    return found->second.built;
  }
  void add(const cl::Context& context, const std::string& key, const cl::Program& built) {
    const std::scoped_lock lock(mutex_);
    if (std::ranges::none_of(contexts_, [&](const auto& e) { return e.second() == context(); }))
      return;
    programs_[{context(), key}] = {built, ++uses_};
    if (programs_.size() <= kKept) return;
    programs_.erase(std::ranges::min_element(programs_, {},
                                             [](const auto& entry) { return entry.second.used; }));
  }

 private:
  struct Kept {
    cl::Program built;
    std::size_t used = 0;
  };
  std::mutex mutex_;
  std::map<cl_device_id, cl::Context> contexts_;
  std::map<std::pair<cl_context, std::string>, Kept> programs_;
  std::size_t uses_ = 0;
};

/// Never released: a driver's own statics may be gone before those of this library.
SharedPrograms& shared_programs() {
  static auto* const all = new SharedPrograms;
  return *all;
}

}  // namespace

cl::Context shared_context(const cl::Device& device) {
  return shared_programs().context_of(device);
}

cl::Program shared_program(const cl::Context& context, const std::string& key) {
  return shared_programs().find(context, key);
}

void share_program(const cl::Context& context, const std::string& key, const cl::Program& built) {
  shared_programs().add(context, key, built);
}

}  // namespace clpv
