// A volume: N coefficients a cell and channel, all of them in one buffer.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "device/session.hpp"

namespace clpv {

/// Shape of a volume. `n` samples along each axis, `coefficients` a sample and channel.
struct VolumeShape {
  int n = 0;
  int coefficients = 0;
  int channels = 3;  ///< light volumes: red, green, blue; geometry volumes: 1
};

/// A volume on the device in the `soa` layout (kernels/volume/soa.h): one plane of samples a channel and
/// coefficient, each plane with a border of one zero sample all round, so that neighbours need no bounds
/// checks.
class Volume {
 public:
  Volume(Session& session, const VolumeShape& shape, const std::string& what);

  const VolumeShape& shape() const { return shape_; }
  cl::Buffer& buffer() { return buffer_; }
  const cl::Buffer& buffer() const { return buffer_; }
  std::size_t bytes() const { return bytes_; }

  void clear(Session& session);
  /// Host order: [channel][coefficient][z][y][x], as in a .npy of shape (channels, N, z, y, x).
  std::vector<float> read(Session& session) const;
  void write(Session& session, const std::vector<float>& values);

 private:
  VolumeShape shape_;
  std::size_t bytes_ = 0;
  cl::Buffer buffer_;
};

/// Text every kernel that handles coefficients starts with (ProgramSource::generated): CLPV_N,
/// CLPV_EACH_COEFFICIENT(DO) and the struct Coefficients of N floats c0, c1, ...
std::string coefficient_macros(int coefficients);

/// The struct `type` of `count` floats c0, c1, ... and CLPV_EACH_`each`(DO), which writes DO(0) DO(1) ...
std::string cell_macros(const std::string& type, const std::string& each, int count);

}  // namespace clpv
