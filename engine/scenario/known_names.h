#pragma once
/// Lists of what would have been known, for the end of a refusal.

#include <cstddef>
#include <span>
#include <string>

namespace vinerow::scenario {

/// "a, b, c", "a, b and 9 more" where there are more than `most` names, "none" without any.
std::string list_known(std::span<const std::string> names, std::size_t most);

}  // namespace vinerow::scenario
