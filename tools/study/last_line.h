#pragma once
/// Last line of a program's output.

#include <string>

namespace vinerow::study {

/// Last non-blank line of a text, cut after 300 characters; "" if all are blank.
std::string last_line_of(const std::string& text);

}  // namespace vinerow::study
