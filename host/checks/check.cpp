#include "checks/check.hpp"

namespace clpv::reference {

CheckResults check(Stage stage, Session& session, bool thorough) {
  switch (stage) {
    case Stage::sizes:
      return check_sizes(session);
    case Stage::rasterize:
      return check_rasterize(session);
    case Stage::inject:
      return check_inject(session, thorough);
    case Stage::block:
      return check_block(session);
    case Stage::propagate:
      return check_propagate(session, thorough);
    case Stage::sweep:
      return check_sweep(session, thorough);
    case Stage::carry_late:
      return check_carry_late(session);
    case Stage::gather:
      return check_gather(session, thorough);
    case Stage::shade:
      return check_shade(session);
  }
  return {};
}

}  // namespace clpv::reference
