#include "engine/io/files/plain_zeros.h"

#include <regex>

namespace vinerow::io {

std::string plain_zeros(const std::string& text) {
  // Not "-0.05", "-0e3", "-0-1", "-0.0.1".
  static const std::regex kNegativeZero(R"((^|[ (\[{])-(0(?:\.0+)?)(?![\w-]|\.\w))");
  return std::regex_replace(text, kNegativeZero, "$1$2");
}

}  // namespace vinerow::io
