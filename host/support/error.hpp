// SPDX-License-Identifier: MIT
// One exception type for everything a user can meet: it is part of the library's door.
#pragma once

#include "clpv/error.hpp"
