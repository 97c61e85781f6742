// SPDX-License-Identifier: MIT
#include "verify/check.hpp"

namespace clpv::reference {

CheckResults check_near(Session&, const CheckScope&) { return {}; }

}  // namespace clpv::reference
