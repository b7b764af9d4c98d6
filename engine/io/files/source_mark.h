#pragma once
/// Where in the user's files something was said.

#include <string>

namespace vinerow::io {

/// A place in a file, or in an option of the command line.
struct SourceMark {
  std::string file;
  int line = 0;              ///< 1-based; 0 = not from a file (--set, default)
  std::string text() const;  ///< "file.yaml:12", or only the file where there is no line
};

}  // namespace vinerow::io
