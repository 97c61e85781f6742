// SPDX-License-Identifier: MIT
// The .icd files that name OpenCL drivers, and those among them that cannot be loaded.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace clpv {

/// A driver that the loader leaves out silently, or that ends or stops the process.
struct FaultyDriver {
  std::string file, reason;
};

/// Returns the .icd files of OCL_ICD_VENDORS (a file, a folder, or a driver's library in their
/// place), by default of /etc/OpenCL/vendors, in the order of their names.
std::vector<std::filesystem::path> driver_files();

/// Loads each driver in a child process and returns those that fail. Without set_helper_program()
/// it loads none, and returns only drivers whose file is missing, no library, or for another
/// machine.
std::vector<FaultyDriver> faulty_drivers();

/// The work of that child process. Throws Error(device) with the linker's words.
void load_driver(const std::filesystem::path& icd_file);

/// From now on the OpenCL loader finds all drivers except `faulty`: links their .icd files into
/// `folder`, which has none before.
void leave_out(const std::vector<FaultyDriver>& faulty, const std::filesystem::path& folder);

}  // namespace clpv
