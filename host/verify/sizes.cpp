// SPDX-License-Identifier: MIT
// Compares the device's layout of the shared structs with the host's; a mismatch would corrupt
// every stage's input.
#include <fmt/format.h>

#include <cstddef>
#include <cstdint>
#include <iterator>

#include "device/kernel.hpp"
#include "kernels/shared/emit.h"
#include "kernels/shared/fields.h"
#include "kernels/shared/grid.h"
#include "kernels/shared/light.h"
#include "kernels/shared/mesh.h"
#include "kernels/shared/raster.h"
#include "kernels/shared/region.h"
#include "kernels/shared/sweep.h"
#include "kernels/shared/view.h"
#include "kernels/shared/view_injection.h"
#include "verify/check.hpp"
#include "verify/tolerances.hpp"

namespace clpv::verify {
namespace {

struct Place {
  const char* name;
  std::uint32_t bytes;
};

constexpr Place kHost[] = {
#define CLPV_FIELD(type, field) \
  {"size of " #type, sizeof(type)}, {#type "." #field, offsetof(type, field)},
    CLPV_EACH_SHARED(CLPV_FIELD)
#undef CLPV_FIELD
};

Deviation compare_sizes(Session& session) {
  const std::size_t count = std::size(kHost);
  Buffer bytes = session.buffer(count * sizeof(std::uint32_t), "sizes of the shared structs");
  Kernel(session, {"sizes.cl"}, "sizes").set(bytes).launch(cl::NDRange(1), cl::NDRange(1));
  const auto device = session.read<std::uint32_t>(bytes, count);

  Ranges ranges;
  for (const Place& place : kHost) ranges.push_back({double(place.bytes), double(place.bytes)});
  if (session.recorder() != nullptr) session.recorder()->expect(bytes.handle(), "uint", ranges);
  Deviation result{0, tolerance("sizes")};
  for (std::size_t i = 0; i < count; ++i) {
    const double error =
        device[i] > kHost[i].bytes ? device[i] - kHost[i].bytes : kHost[i].bytes - device[i];
    result.take(error, [&] {
      return fmt::format("{}: {} bytes, host {}", kHost[i].name, device[i], kHost[i].bytes);
    });
  }
  return result;
}

}  // namespace

Cases sizes_cases(const CheckScope&) {
  return {deviation_case(Stage::sizes, "shared structs", compare_sizes)};
}

}  // namespace clpv::verify
