#pragma once
/// What a program said at last.

#include <string>

namespace vinerow::study {

/// The last line of a text that is not blank, without what is beyond 300 characters; "" where there
/// is none.
std::string last_line_of(const std::string& text);

}  // namespace vinerow::study
