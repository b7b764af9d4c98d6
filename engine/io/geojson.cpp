#include "engine/io/geojson.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>

#include "engine/core/error.h"
#include "engine/core/files.h"
#include "engine/core/suggest.h"
#include "engine/math/angles.h"

namespace vinerow::io {
namespace {

using nlohmann::json;

struct Place {
  const std::filesystem::path& file;
  int index;
  std::string text() const { return fmt::format("'{}', feature {}", file.string(), index); }
};

json parse_file(const std::filesystem::path& file) {
  std::optional<std::string> bytes = read_bytes(file);
  if (!bytes) throw ConfigError(fmt::format("GeoJSON file '{}' does not exist", file.string()));
  std::string& text = *bytes;
  const std::string kByteOrderMark = "\xEF\xBB\xBF";
  if (text.rfind(kByteOrderMark, 0) == 0) text.erase(0, 3);
  try {
    return json::parse(text);
  } catch (const json::parse_error& e) {
    const auto end = text.begin() + static_cast<std::ptrdiff_t>(std::min<std::size_t>(
                                        e.byte ? e.byte - 1 : 0, text.size()));
    const auto line = 1 + std::count(text.begin(), end, '\n');
    throw ConfigError(
        fmt::format("GeoJSON file '{}' is not valid JSON (line {})", file.string(), line));
  }
}

Geodetic read_position(const json& position, const Place& place, bool& has_altitude) {
  const auto is_number = [](const json& value) { return value.is_number(); };
  if (!position.is_array() || position.size() < 2 ||
      !std::all_of(position.begin(), position.end(), is_number)) {
    throw ConfigError(
        fmt::format("{}: coordinate {} must be [longitude, latitude] in finite numbers",
                    place.text(), position.dump()));
  }
  const double longitude_deg = position[0], latitude_deg = position[1];
  const double altitude_m = position.size() > 2 ? position[2].get<double>() : 0.0;
  if (!(std::abs(longitude_deg) <= 180.0) || !(std::abs(latitude_deg) <= 90.0) ||
      !std::isfinite(altitude_m)) {
    throw ConfigError(
        fmt::format("{}: coordinate {} is not WGS84 degrees (longitude within +-180, latitude "
                    "within +-90); projected "
                    "coordinates must be converted first",
                    place.text(), position.dump()));
  }
  has_altitude = has_altitude && position.size() > 2;
  return {rad_from_deg(latitude_deg), rad_from_deg(longitude_deg), altitude_m};
}

void add_geometry(const json& geometry, GeoFeature feature, const Place& place,
                  std::vector<GeoFeature>& features);

void add_positions(const json& positions, GeometryKind kind, GeoFeature feature, const Place& place,
                   std::vector<GeoFeature>& features) {
  feature.kind = kind;
  feature.has_altitude = true;
  if (kind == GeometryKind::kPoint) {
    feature.points = {read_position(positions, place, feature.has_altitude)};
  } else {
    if (!positions.is_array()) {
      throw ConfigError(fmt::format("{}: coordinates must be a list of points", place.text()));
    }
    for (const json& position : positions) {
      feature.points.push_back(read_position(position, place, feature.has_altitude));
    }
    if (feature.points.size() < 2) {
      throw ConfigError(fmt::format("{}: a line needs at least 2 points, it has {}", place.text(),
                                    feature.points.size()));
    }
  }
  features.push_back(std::move(feature));
}

const json& member(const json& object, const char* name, const Place& place) {
  if (!object.is_object() || !object.contains(name)) {
    throw ConfigError(fmt::format("{}: '{}' is missing", place.text(), name));
  }
  return object.at(name);
}

void add_geometry(const json& geometry, GeoFeature feature, const Place& place,
                  std::vector<GeoFeature>& features) {
  if (geometry.is_null()) return;  // RFC 7946, section 3.2: an unlocated feature
  const json& type_value = member(geometry, "type", place);
  const std::string type =
      type_value.is_string() ? type_value.get<std::string>() : type_value.dump();
  if (type == "GeometryCollection") {
    for (const json& part : member(geometry, "geometries", place)) {
      add_geometry(part, feature, place, features);
    }
    return;
  }
  const json& coordinates = member(geometry, "coordinates", place);
  const auto each = [&](const auto& add) {
    if (!coordinates.is_array()) {
      throw ConfigError(fmt::format("{}: coordinates must be a list", place.text()));
    }
    for (const json& part : coordinates) add(part);
  };
  const auto outer_ring = [&](const json& polygon) -> const json& {
    if (!polygon.is_array() || polygon.empty()) {
      throw ConfigError(fmt::format("{}: a polygon needs an outer ring", place.text()));
    }
    return polygon.front();
  };
  if (type == "Point") {
    add_positions(coordinates, GeometryKind::kPoint, feature, place, features);
  } else if (type == "LineString") {
    add_positions(coordinates, GeometryKind::kLineString, feature, place, features);
  } else if (type == "Polygon") {
    add_positions(outer_ring(coordinates), GeometryKind::kPolygon, feature, place, features);
  } else if (type == "MultiPoint") {
    each([&](const json& p) { add_positions(p, GeometryKind::kPoint, feature, place, features); });
  } else if (type == "MultiLineString") {
    each([&](const json& p) {
      add_positions(p, GeometryKind::kLineString, feature, place, features);
    });
  } else if (type == "MultiPolygon") {
    each([&](const json& p) {
      add_positions(outer_ring(p), GeometryKind::kPolygon, feature, place, features);
    });
  } else {
    throw ConfigError(fmt::format("{}: unknown geometry '{}'", place.text(), type));
  }
}

void add_feature(const json& object, int index, const std::filesystem::path& file,
                 std::vector<GeoFeature>& features) {
  const Place place{file, index};
  GeoFeature feature;
  feature.index = index;
  if (object.is_object() && object.contains("properties") && object["properties"].is_object()) {
    for (const auto& [name, value] : object["properties"].items()) {
      feature.properties[name] = value.is_string() ? value.get<std::string>() : value.dump();
    }
  }
  add_geometry(member(object, "geometry", place), feature, place, features);
}

std::string lower(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return text;
}

/// Surveys say what a point is in `type`, `feature_type` or in its name ("ROW01POLE01").
std::string words_of(const GeoFeature& feature) {
  std::string words;
  for (const char* key : {"type", "feature_type", "name", "Point"}) {
    words += lower(feature.property(key)) + " ";
  }
  return words;
}

}  // namespace

std::string GeoFeature::property(const std::string& name) const {
  const auto found = properties.find(name);
  return found == properties.end() ? "" : found->second;
}

std::vector<GeoFeature> read_geojson(const std::filesystem::path& file) {
  const json root = parse_file(file);
  std::vector<GeoFeature> features;
  const std::string type =
      root.is_object() && root.contains("type") && root["type"].is_string() ? root["type"] : "";
  if (type == "FeatureCollection") {
    if (!root.contains("features") || !root["features"].is_array()) {
      throw ConfigError(fmt::format("GeoJSON file '{}': 'features' must be a list", file.string()));
    }
    int index = 0;
    for (const json& feature : root["features"]) add_feature(feature, index++, file, features);
  } else if (type == "Feature") {
    add_feature(root, 0, file, features);
  } else if (!type.empty()) {
    add_geometry(root, GeoFeature{}, Place{file, 0}, features);
  } else {
    throw ConfigError(
        fmt::format("file '{}' is JSON but not GeoJSON: it has no 'type'", file.string()));
  }
  return features;
}

SurveyFile read_survey(const std::filesystem::path& file, const std::string& row_type) {
  const std::vector<GeoFeature> features = read_geojson(file);
  const std::set<std::string> kRowTypes = {"row", "vine_row", "connection_line"};
  int lines = 0, points = 0;
  bool any_named_row = false;
  std::set<std::string> types;
  for (const GeoFeature& feature : features) {
    points += feature.kind == GeometryKind::kPoint;
    if (feature.kind != GeometryKind::kLineString) continue;
    ++lines;
    types.insert(feature.property("type"));
    any_named_row = any_named_row || kRowTypes.count(feature.property("type")) > 0;
  }
  if (lines == 0) {
    throw ConfigError(fmt::format(
        "GeoJSON file '{}' has no LineString ({} points, {} other features): each row must "
        "be a LineString",
        file.string(), points, features.size() - points));
  }
  SurveyFile survey;
  for (const GeoFeature& feature : features) {
    const std::string type = feature.property("type");
    if (feature.kind == GeometryKind::kLineString) {
      const bool wanted = !row_type.empty() ? type == row_type
                          : any_named_row   ? kRowTypes.count(type) > 0
                                            : type != "mid_row_line";
      if (wanted) survey.rows.push_back(feature);
    } else if (feature.kind == GeometryKind::kPoint) {
      const std::string words = words_of(feature);
      if (words.find("pole") != std::string::npos || words.find("post") != std::string::npos) {
        survey.poles.push_back(feature);
      } else if (words.find("vine") != std::string::npos ||
                 words.find("tree") != std::string::npos) {
        survey.vines.push_back(feature);
      }
    }
  }
  if (survey.rows.empty()) {
    const std::vector<std::string> known(types.begin(), types.end());
    throw ConfigError(fmt::format(
        "GeoJSON file '{}' has {} LineStrings but none of type '{}' (types: {}){}", file.string(),
        lines, row_type.empty() ? "row" : row_type, join(known), did_you_mean(row_type, known)));
  }
  return survey;
}

}  // namespace vinerow::io
