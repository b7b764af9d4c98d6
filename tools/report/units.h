#pragma once
/// Units and readable words from the names of numbers.

#include <string>

namespace vinerow::tools::report {

/// Unit of a name: "m/s" for "row_speed_mean_mps"; "" without a unit.
std::string unit_of(const std::string& name);

/// Name without its unit, with spaces: "row speed mean".
std::string words_of(const std::string& name);

/// Text with an upper-case first letter.
std::string sentence_case(std::string words);

}  // namespace vinerow::tools::report
