#pragma once
/// Comparison of a plug-in's ABI with that of this program.

#include <string>
#include <string_view>

namespace vinerow {

/// Compares two ABI tags (engine/api/abi.h) field by field.
/// @param plugin  tag of the plug-in; any text, including tags from before version 9
/// @returns "" if they are compatible, else the first difference that explains the others: "was
/// compiled with 32-byte alignment (-mavx or -march=native?), this vinerow uses 16"
std::string abi_difference(std::string_view plugin, std::string_view program);

}  // namespace vinerow
