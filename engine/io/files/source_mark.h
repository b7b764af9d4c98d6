#pragma once
/// Positions in the user's files, for messages.

#include <string>

namespace vinerow::io {

/// Position in a file, or an option of the command line.
struct SourceMark {
  std::string file;
  int line = 0;              ///< 1-based; 0 = not from a file (--set, default)
  bool is_override = false;  ///< of a study or --set, in place of the scenario's own value
  std::string text() const;  ///< "file.yaml:12", or only the file if there is no line
};

}  // namespace vinerow::io
