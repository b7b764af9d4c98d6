#pragma once
/// What the ending of a name says of its unit, for people.

#include <string>

namespace vinerow::tools::report {

/// "m/s" of "row_speed_mean_mps"; "" of what has no unit.
std::string unit_of(const std::string& name);

/// The name without its unit, spaced: "row speed mean".
std::string words_of(const std::string& name);

/// The same with its first letter large.
std::string sentence_case(std::string words);

}  // namespace vinerow::tools::report
