// SPDX-License-Identifier: MIT
// What the baselines by hand share: when AVX2 may be used, and memory for it.
#pragma once

#include <cstddef>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <new>

#if defined(__x86_64__) && defined(__GNUC__)
#include <immintrin.h>
#define CLPV_HAS_AVX2 1
// By function and not by file: templates shared with other files must run on every processor. prfchw: prefetchw, which does
// nothing where a processor does not know it.
#define CLPV_AVX2 __attribute__((target("avx2,fma,prfchw")))
#else
#define CLPV_HAS_AVX2 0
#endif

namespace clpv::bench {

/// Whether it was built for this architecture and this processor has AVX2 and FMA.
inline bool baseline_supported() {
#if CLPV_HAS_AVX2
  return __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma");
#else
  return false;
#endif
}

inline constexpr int kLane = 8;  ///< floats in a vector

/// Floats on 64-byte boundaries, 0 at first.
class Plane {
 public:
  explicit Plane(std::size_t count)
      : count_(count), values_(static_cast<float*>(std::aligned_alloc(64, bytes()))) {
    if (!values_) throw std::bad_alloc();
    clear();
  }
  float* data() const { return values_.get(); }
  void clear() { std::memset(data(), 0, bytes()); }
  std::size_t bytes() const { return (count_ * sizeof(float) + 63) / 64 * 64; }

 private:
  struct Free {
    void operator()(float* p) const { std::free(p); }
  };
  std::size_t count_;
  std::unique_ptr<float, Free> values_;
};

}  // namespace clpv::bench
