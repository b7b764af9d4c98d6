#pragma once
/// Quoting of texts for a shell.

#include <string>

namespace vinerow::study {

/// Text in single quotes of a POSIX shell.
std::string shell_quoted(const std::string& text);

}  // namespace vinerow::study
