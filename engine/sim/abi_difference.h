#pragma once
/// Why a plug-in does not fit this program.

#include <string>
#include <string_view>

namespace vinerow {

/// Compares two ABI tags (engine/api/abi.h) field by field.
/// @param plugin  what the plug-in says of itself; anything, also tags of before version 9
/// @returns "" where they fit, else the first difference that explains the others: "was compiled
/// with 32-byte alignment (-mavx or -march=native?), this vinerow uses 16"
std::string abi_difference(std::string_view plugin, std::string_view program);

}  // namespace vinerow
