#include "pipeline/volume.hpp"

#include "support/error.hpp"

namespace clpv {
namespace {

std::size_t pitch(const VolumeShape& shape) {
  return static_cast<std::size_t>(shape.n) + 2;
}

std::size_t planes(const VolumeShape& shape) {
  return static_cast<std::size_t>(shape.channels) * static_cast<std::size_t>(shape.coefficients);
}

/// Calls visit(index in the padded planes, index in host order) for every coefficient of every sample.
template <typename Visit>
void for_each_sample(const VolumeShape& shape, Visit visit) {
  const std::size_t n = static_cast<std::size_t>(shape.n), p = pitch(shape);
  std::size_t host = 0;
  for (std::size_t plane = 0; plane < planes(shape); ++plane) {
    for (std::size_t z = 0; z < n; ++z) {
      for (std::size_t y = 0; y < n; ++y) {
        for (std::size_t x = 0; x < n; ++x) visit(((plane * p + z + 1) * p + y + 1) * p + x + 1, host++);
      }
    }
  }
}

}  // namespace

Volume::Volume(Session& session, const VolumeShape& shape, const std::string& what)
    : shape_(shape),
      bytes_(planes(shape) * pitch(shape) * pitch(shape) * pitch(shape) * sizeof(float)),
      buffer_(session.buffer(bytes_, what)) {
  clear(session);
}

void Volume::clear(Session& session) {
  session.fill_zero(buffer_, bytes_);
}

std::vector<float> Volume::read(Session& session) const {
  const std::vector<float> padded = session.read<float>(buffer_, bytes_ / sizeof(float));
  std::vector<float> values(planes(shape_) * shape_.n * shape_.n * shape_.n);
  for_each_sample(shape_, [&](std::size_t from, std::size_t to) { values[to] = padded[from]; });
  return values;
}

void Volume::write(Session& session, const std::vector<float>& values) {
  std::vector<float> padded(bytes_ / sizeof(float), 0.0f);
  for_each_sample(shape_, [&](std::size_t to, std::size_t from) { padded[to] = values.at(from); });
  session.write(buffer_, padded);
}

std::string cell_macros(const std::string& type, const std::string& each, int count) {
  std::string list, fields;
  for (int i = 0; i < count; ++i) {
    list += fmt::format(" DO({})", i);
    fields += fmt::format("{} c{}", i == 0 ? "" : ",", i);
  }
  return fmt::format("#define CLPV_EACH_{}(DO){}\ntypedef struct {{\n  float{};\n}} {};\n", each, list,
                     fields, type);
}

std::string coefficient_macros(int coefficients) {
  // Inlined by the compiler's front end: left to later passes, structs would be passed in memory or in vector registers,
  // and work-items would no longer vectorise on CPU devices.
  return "#define CLPV_INLINE static inline __attribute__((always_inline))\n" +
         fmt::format("#define CLPV_N {}\n", coefficients) +
         cell_macros("Coefficients", "COEFFICIENT", coefficients);
}

}  // namespace clpv
