#include "tools/study/last_line.h"

#include <algorithm>

namespace vinerow::study {

std::string last_line_of(const std::string& text) {
  constexpr std::size_t kLongest = 300;
  const std::size_t end = text.find_last_not_of(" \t\r\n");
  if (end == std::string::npos) return "";
  const std::size_t begin = text.rfind('\n', end) + 1;  // 0 if there is no line before
  return text.substr(begin, std::min(end + 1 - begin, kLongest));
}

}  // namespace vinerow::study
