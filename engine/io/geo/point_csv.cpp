#include "engine/io/geo/point_csv.h"

#include <fmt/format.h>

#include <cctype>
#include <locale>
#include <optional>
#include <sstream>

#include "engine/core/error.h"
#include "engine/core/files.h"

namespace vinerow::io {
namespace {

bool is_name(const std::string& line) {
  const char first = line.front();
  return first == '"' || first == '\'' || std::isalpha(static_cast<unsigned char>(first)) != 0;
}

}  // namespace

std::vector<Eigen::Vector2d> read_points_csv(const std::string& file) {
  const std::optional<std::string> text = read_bytes(file);
  if (!text) throw ConfigError(fmt::format("{}: cannot be read", file));
  std::istringstream stream(*text);
  std::vector<Eigen::Vector2d> points;
  std::string line;
  for (int number = 1; std::getline(stream, line); ++number) {
    const std::string kByteOrderMark = "\xEF\xBB\xBF";
    if (number == 1 && line.rfind(kByteOrderMark, 0) == 0) line.erase(0, kByteOrderMark.size());
    while (!line.empty() && (line.back() == '\r' || line.back() == ' ')) line.pop_back();
    if (line.empty() || line.front() == '#') continue;
    std::string fields = line;
    for (char& c : fields) c = (c == ',' || c == ';') ? ' ' : c;
    std::istringstream parser(fields);
    parser.imbue(std::locale::classic());
    Eigen::Vector2d p;
    std::string rest;
    if (parser >> p.x() >> p.y() && p.allFinite() && !(parser >> rest)) {
      points.push_back(p);
    } else if (number > 1 || !is_name(line)) {
      throw ConfigError(
          fmt::format("{}:{}: '{}' must be two numbers, x and y in metres", file, number, line));
    }
  }
  if (points.empty()) throw ConfigError(fmt::format("{}: has no points", file));
  return points;
}

}  // namespace vinerow::io
