// Uses what every user of the library does: a basis (no OpenCL), a device, an embedded kernel's result.
#include <fmt/format.h>

#include "basis/basis.hpp"
#include "checks/check.hpp"
#include "device/session.hpp"

int main() {
  const auto basis = clpv::make_basis("sh2");
  clpv::Session session(clpv::choose_device());
  const auto results = clpv::reference::check_sizes(session);
  fmt::print("{} has {} coefficients; {} says: {}\n", basis->name(), basis->size(), session.device().name,
             results.front().passed() ? "sizes agree" : results.front().place);
  return results.front().passed() ? 0 : 1;
}
