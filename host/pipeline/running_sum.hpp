// A sum of volumes that each launch adds to.
#pragma once

#include "pipeline/volume.hpp"

namespace clpv {

/// A buffer is added to in place. An image cannot be both read and written by one launch (OpenCL 1.2): it takes turns
/// with a spare one, such that after the given number of additions the sum is in `result`.
class RunningSum {
 public:
  /// `spare`: not used where `result` is updated in place.
  RunningSum(Volume& result, Volume* spare, int additions)
      : result_(result), spare_(result.updates_in_place() ? &result : spare), left_(additions) {}

  Volume& so_far() { return left_ % 2 == 0 ? result_ : *spare_; }  ///< what the next addition reads
  Volume& next() { return left_ % 2 == 1 ? result_ : *spare_; }    ///< and what it writes
  void added() { --left_; }

 private:
  Volume& result_;
  Volume* spare_;
  int left_;  ///< additions to come
};

}  // namespace clpv
