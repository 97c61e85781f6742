// SPDX-License-Identifier: MIT
// Which device each rank of a team works on.
#pragma once

#include <string>

#include "device/device.hpp"
#include "parallel/team.hpp"

namespace clpv {

/// Alone, choose_device(choice). Else the ranks of a machine take the devices that `choice` fits in turn; where these are
/// fewer, those that share one split it into as many parts of equal compute units, or share it whole where it cannot be
/// split. By each rank on its own. Throws what choose_devices throws.
Device device_of_rank(const Team& team, const std::string& choice);

/// Logs at rank 0 who has what, and warns of processors that ranks are bound to which are fewer than their devices'.
/// Of all ranks.
void tell_devices(Team& team, const Device& device);

}  // namespace clpv
