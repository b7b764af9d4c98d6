#pragma once
/// Reader for JSON files of runs and maps.

#include <filesystem>
#include <nlohmann/json.hpp>

namespace vinerow::tools {

/// @throws ConfigError "runs/x/summary.json: cannot be read" | "...: is not JSON" | "...: must be
/// an object"
nlohmann::ordered_json read_json_file(const std::filesystem::path& file);

}  // namespace vinerow::tools
