#include "tools/compare/json_file.h"

#include "engine/core/error.h"
#include "engine/core/files.h"

namespace vinerow::tools {

nlohmann::ordered_json read_json_file(const std::filesystem::path& file) {
  const auto text = read_bytes(file);
  if (!text) throw ConfigError(file.string() + ": cannot be read");
  nlohmann::ordered_json json = nlohmann::ordered_json::parse(*text, nullptr, false);
  if (json.is_discarded()) throw ConfigError(file.string() + ": is not JSON");
  if (!json.is_object()) throw ConfigError(file.string() + ": must be an object");
  return json;
}

}  // namespace vinerow::tools
