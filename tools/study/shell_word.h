#pragma once
/// Texts as words of a shell.

#include <string>

namespace vinerow::study {

/// Between single quotes of a POSIX shell.
std::string shell_quoted(const std::string& text);

}  // namespace vinerow::study
