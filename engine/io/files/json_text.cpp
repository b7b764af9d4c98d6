#include "engine/io/files/json_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "engine/core/error.h"

namespace vinerow::io {

nlohmann::json parse_json(const std::string& text, const std::string& subject) {
  try {
    return nlohmann::json::parse(text);
  } catch (const nlohmann::json::parse_error& error) {
    const std::size_t end = std::min<std::size_t>(error.byte > 0 ? error.byte - 1 : 0, text.size());
    const auto line =
        1 + std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(end), '\n');
    throw ConfigError(fmt::format("{} is not valid JSON (line {})", subject, line));
  } catch (const nlohmann::json::exception&) {  // a number beyond double's range
    throw ConfigError(fmt::format("{} has a number that is too large", subject));
  }
}

}  // namespace vinerow::io
