#pragma once
/// Default and range of a parameter as text, for lists and help.

#include <string>

#include "engine/api/parameters.h"

namespace vinerow::tools {

/// Computed defaults are rounded to six digits.
/// @returns "0.14", "[1, 6]", "\"\"" for an empty text, "required", "-" without a default
std::string default_text(const ParameterSpec& spec);

/// @returns "a | b" for choices, "[0, 1]", "(0, 1]", "> 0", "" if every value is allowed
std::string range_text(const ParameterSpec& spec);

}  // namespace vinerow::tools
