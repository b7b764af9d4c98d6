#pragma once
/// Libraries that belong to the simulator and are opened at run time, where they are needed.

#include <filesystem>
#include <string>

namespace vinerow {

/// Flag of dlopen() with which a library takes symbols from its own libraries before those that the
/// program has loaded. The address sanitizer refuses it: its functions must come first.
int own_libraries_first();

/// Path of such a library: beside the library or program that contains this function, or in the
/// folder `lib` next to a program's `bin`. It need not exist.
std::filesystem::path find_own_library(const std::string& name);

}  // namespace vinerow
