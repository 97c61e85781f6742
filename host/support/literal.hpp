// SPDX-License-Identifier: MIT
// Numbers as text of the kernel language.
#pragma once

#include <string>

namespace clpv {

/// A float literal of the kernel language that reads back as float(value): "0.25f", "1e-05f", "(-0.5f)".
/// Throws Error(run_time) for a value that a float cannot hold.
std::string float_literal(double value);

}  // namespace clpv
