#pragma once
/// Parser of JSON texts from users.

#include <nlohmann/json_fwd.hpp>
#include <string>

namespace vinerow::io {

/// @param subject  "GeoJSON file 'a.geojson'", for the message
/// @throws ConfigError "<subject> is not valid JSON (line 3)", "<subject> has a number that is too
/// large"
nlohmann::json parse_json(const std::string& text, const std::string& subject);

}  // namespace vinerow::io
