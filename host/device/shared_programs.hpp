// SPDX-License-Identifier: MIT
// Sessions of one process share a context for each device, and the programs built in it. With
// PoCL 3.1, a program that its own cache holds still takes 20 to 40 ms to build, and a frame has up
// to 40.
#pragma once

#include <CL/opencl.hpp>
#include <string>

namespace clpv {

/// Returns the context of a device, which lives as long as the process.
cl::Context shared_context(const cl::Device& device);

/// Returns the program of that ProgramCache::key in a context of shared_context(); null if none was
/// built, if many others were used since, or in any other context. Thread safe.
cl::Program shared_program(const cl::Context& context, const std::string& key);

/// Keeps a built program for later sessions, if its context is one of shared_context(). Thread
/// safe.
void share_program(const cl::Context& context, const std::string& key, const cl::Program& built);

}  // namespace clpv
