#include "engine/io/geo/geojson.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <iterator>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>

#include "engine/core/error.h"
#include "engine/core/files.h"
#include "engine/core/suggest.h"
#include "engine/io/files/json_text.h"
#include "engine/io/geo/crs.h"
#include "engine/io/geo/geo_features.h"
#include "engine/io/geo/quiet_gdal.h"
#include "engine/math/angles.h"

namespace vinerow::io {
namespace {

using nlohmann::json;

struct Place {
  const std::filesystem::path& file;
  int index;
  const Transformation& to_wgs84;  ///< none: the numbers are WGS84
  std::string text() const { return fmt::format("'{}', feature {}", file.string(), index); }
};

/// Rejects JSON nested deeper than any GeoJSON, which would exhaust the stack of recursive
/// functions.
void check_depth(const std::string& text, const std::filesystem::path& file) {
  constexpr int kDeepest = 100;
  int depth = 0;
  bool in_text = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (in_text && c == '\\') ++i;
    if (c == '"') in_text = !in_text;
    if (in_text) continue;
    if (c == '[' || c == '{') ++depth;
    if (c == ']' || c == '}') --depth;
    if (depth > kDeepest) {
      throw ConfigError(fmt::format("GeoJSON file '{}' is nested deeper than {} levels",
                                    file.string(), kDeepest));
    }
  }
}

/// A value as shown in errors, cut after 60 characters.
std::string shown(const json& value) {
  constexpr std::size_t kMax = 60;
  const std::string text = value.dump(-1, ' ', true, json::error_handler_t::replace);
  return text.size() <= kMax ? text : text.substr(0, kMax) + "...";
}

/// Transformation for the `crs` member of GeoJSON from before RFC 7946; null if it is absent or
/// means WGS84.
Transformation read_crs_member(const json& root, const std::filesystem::path& file) {
  if (!root.is_object() || !root.contains("crs") || root["crs"].is_null()) return {};
  const json& crs = root["crs"];
  std::string name;
  if (crs.is_object() && crs.contains("properties") && crs["properties"].is_object() &&
      crs["properties"].contains("name") && crs["properties"]["name"].is_string()) {
    name = crs["properties"]["name"].get<std::string>();
  }
  if (name.empty()) {
    throw ConfigError(fmt::format(
        "GeoJSON file '{}': crs = {}, must be like {{\"type\": \"name\", \"properties\": "
        "{{\"name\": \"EPSG:25832\"}}}}",
        file.string(), shown(crs)));
  }
  const QuietGdal quiet;
  std::optional<Crs> from;
  try {
    from = parse_crs(name);
  } catch (const ConfigError& error) {
    throw ConfigError(fmt::format("GeoJSON file '{}': {}", file.string(), error.what()));
  }
  const Crs wgs84 = make_wgs84();
  if (from->is_geographic() && gdal().OSRIsSameGeogCS(from->get(), wgs84.get()) != 0) return {};
  Transformation result(*from, wgs84);
  if (!result) {
    throw ConfigError(fmt::format("GeoJSON file '{}': no transformation from '{}' to WGS84",
                                  file.string(), name));
  }
  return result;
}

json parse_file(const std::filesystem::path& file) {
  std::optional<std::string> bytes = read_bytes(file);
  if (!bytes) throw ConfigError(fmt::format("GeoJSON file '{}' does not exist", file.string()));
  std::string& text = *bytes;
  const std::string kByteOrderMark = "\xEF\xBB\xBF";
  if (text.rfind(kByteOrderMark, 0) == 0) text.erase(0, 3);
  check_depth(text, file);
  return parse_json(text, fmt::format("GeoJSON file '{}'", file.string()));
}

Geodetic read_position(const json& position, const Place& place, bool& has_altitude) {
  const auto is_number = [](const json& value) { return value.is_number(); };
  if (!position.is_array() || position.size() < 2 ||
      !std::all_of(position.begin(), position.end(), is_number)) {
    throw ConfigError(
        fmt::format("{}: coordinate {} must be [longitude, latitude] in finite numbers",
                    place.text(), shown(position)));
  }
  double longitude_deg = position[0], latitude_deg = position[1];
  const double altitude_m = position.size() > 2 ? position[2].get<double>() : 0.0;
  const bool is_converted =
      !place.to_wgs84 || (std::isfinite(longitude_deg) && std::isfinite(latitude_deg) &&
                          place.to_wgs84.apply(longitude_deg, latitude_deg));
  if (!is_converted || !(std::abs(longitude_deg) <= 180.0) || !(std::abs(latitude_deg) <= 90.0) ||
      !std::isfinite(altitude_m)) {
    if (place.to_wgs84) {
      throw ConfigError(
          fmt::format("{}: coordinate {} cannot be transformed from the file's crs to WGS84",
                      place.text(), shown(position)));
    }
    throw ConfigError(
        fmt::format("{}: coordinate {} is not WGS84 degrees (longitude within +-180, latitude "
                    "within +-90); convert projected coordinates with 'ogr2ogr -s_srs EPSG:<code> "
                    "-t_srs EPSG:4326 out.geojson in.geojson', or name their system in a member "
                    "'crs'",
                    place.text(), shown(position)));
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

void add_feature(const json& object, const Place& place, std::vector<GeoFeature>& features) {
  const int index = place.index;
  GeoFeature feature;
  feature.index = index;
  if (object.is_object() && object.contains("properties") && object["properties"].is_object()) {
    for (const auto& [name, value] : object["properties"].items()) {
      feature.properties[name] = value.is_string()
                                     ? value.get<std::string>()
                                     : value.dump(-1, ' ', false, json::error_handler_t::replace);
    }
  }
  add_geometry(member(object, "geometry", place), feature, place, features);
}

std::string lower(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return text;
}

/// Surveys state the kind of a point in `type`, `feature_type` or its name ("ROW01POLE01").
std::string words_of(const GeoFeature& feature) {
  std::string words;
  for (const char* key : {"type", "feature_type", "name", "Point"}) {
    words += lower(feature.property(key)) + " ";
  }
  return words;
}

/// Row number of a point, "" if it is missing.
std::string row_of(const GeoFeature& feature) {
  for (const char* key : {"row", "row_id", "row_number", "row_nr", "Row", "ROW"}) {
    const std::string row = feature.property(key);
    if (!row.empty() && row != "null") return row;
  }
  return "";
}

/// Rows from points with row numbers, such as end poles: points of one number form a line between
/// the two that are farthest apart.
std::vector<GeoFeature> rows_of_points(const std::vector<GeoFeature>& features,
                                       const std::filesystem::path& file) {
  const auto is_pole = [](const GeoFeature& feature) {
    const std::string words = words_of(feature);
    return words.find("pole") != std::string::npos || words.find("post") != std::string::npos;
  };
  bool has_poles = false;
  for (const GeoFeature& feature : features) {
    has_poles |=
        feature.kind == GeometryKind::kPoint && !row_of(feature).empty() && is_pole(feature);
  }
  std::map<std::string, std::vector<const GeoFeature*>> points;
  std::vector<std::string> order;  // as in the file
  for (const GeoFeature& feature : features) {
    const std::string row = feature.kind == GeometryKind::kPoint ? row_of(feature) : "";
    if (row.empty() || (has_poles && !is_pole(feature))) continue;
    if (points[row].empty()) order.push_back(row);
    points[row].push_back(&feature);
  }
  std::vector<GeoFeature> rows;
  for (const std::string& name : order) {
    const std::vector<const GeoFeature*>& of_row = points[name];
    if (of_row.size() < 2) {
      throw ConfigError(
          fmt::format("'{}', feature {}: row '{}' has one point, it needs two: its end poles",
                      file.string(), of_row.front()->index, name));
    }
    // Local plane: longitude is scaled by the cosine of the latitude.
    const double shrink = std::cos(of_row.front()->points.front().latitude_rad);
    const auto place = [&](const GeoFeature* feature) {
      const Geodetic& p = feature->points.front();
      return Eigen::Vector2d(shrink * p.longitude_rad, p.latitude_rad);
    };
    const auto farthest_from = [&](const GeoFeature* from) {
      return *std::max_element(of_row.begin(), of_row.end(), [&](const auto* a, const auto* b) {
        return (place(a) - place(from)).norm() < (place(b) - place(from)).norm();
      });
    };
    // Among points on a line, the farthest from any point is an end.
    const GeoFeature* first = farthest_from(of_row.front());
    const Eigen::Vector2d along = place(farthest_from(first)) - place(first);
    std::vector<const GeoFeature*> sorted = of_row;
    std::stable_sort(sorted.begin(), sorted.end(), [&](const auto* a, const auto* b) {
      return place(a).dot(along) < place(b).dot(along);
    });
    GeoFeature row;
    row.kind = GeometryKind::kLineString;
    row.index = of_row.front()->index;
    row.properties = {{"type", "row"}, {"row", name}};
    for (const GeoFeature* point : sorted) row.points.push_back(point->points.front());
    rows.push_back(std::move(row));
  }
  return rows;
}

}  // namespace

std::string GeoFeature::property(const std::string& name) const {
  const auto found = properties.find(name);
  return found == properties.end() ? "" : found->second;
}

std::vector<GeoFeature> read_geojson(const std::filesystem::path& file) {
  const json root = parse_file(file);
  std::vector<GeoFeature> features;
  const Transformation to_wgs84 = read_crs_member(root, file);
  std::optional<QuietGdal> quiet;
  if (to_wgs84) quiet.emplace();
  const auto place_of = [&](int index) { return Place{file, index, to_wgs84}; };
  const std::string type =
      root.is_object() && root.contains("type") && root["type"].is_string() ? root["type"] : "";
  if (type == "FeatureCollection") {
    if (!root.contains("features") || !root["features"].is_array()) {
      throw ConfigError(fmt::format("GeoJSON file '{}': 'features' must be a list", file.string()));
    }
    int index = 0;
    for (const json& feature : root["features"]) {
      add_feature(feature, place_of(index++), features);
    }
  } else if (type == "Feature") {
    add_feature(root, place_of(0), features);
  } else if (!type.empty()) {
    add_geometry(root, GeoFeature{}, place_of(0), features);
  } else {
    throw ConfigError(
        fmt::format("file '{}' is JSON but not GeoJSON: it has no 'type'", file.string()));
  }
  return features;
}

SurveyFile read_survey(const std::filesystem::path& file, const std::string& row_type) {
  std::vector<GeoFeature> features = read_features(file);
  const bool has_lines = std::any_of(features.begin(), features.end(), [](const auto& feature) {
    return feature.kind == GeometryKind::kLineString;
  });
  if (!has_lines && row_type.empty()) {
    std::vector<GeoFeature> rows = rows_of_points(features, file);
    features.insert(features.end(), std::make_move_iterator(rows.begin()),
                    std::make_move_iterator(rows.end()));
  }
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
        "{} has no LineString ({} points, {} other features): each row must be a LineString, or "
        "points, its end poles, with its number as the property 'row'",
        name_of_feature_file(file), points, features.size() - points));
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
      } else if (has_lines) {
        ++survey.other_points;
      }
    } else {
      ++survey.areas;
    }
  }
  if (survey.rows.empty()) {
    const std::vector<std::string> known(types.begin(), types.end());
    throw ConfigError(fmt::format(
        "{} has {} LineStrings but none of type '{}' (types: {}){}", name_of_feature_file(file),
        lines, row_type.empty() ? "row" : row_type, join(known), did_you_mean(row_type, known)));
  }
  return survey;
}

}  // namespace vinerow::io
