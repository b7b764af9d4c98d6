#pragma once
/// Lists of known names for error messages.

#include <cstddef>
#include <span>
#include <string>

namespace vinerow::scenario {

/// "a, b, c", "a, b and 9 more" if there are more than `max_count` names, "none" if there are no
/// names.
std::string list_known(std::span<const std::string> names, std::size_t max_count);

}  // namespace vinerow::scenario
