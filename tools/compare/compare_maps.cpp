#include "tools/compare/compare_maps.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "engine/core/error.h"
#include "engine/math/angles.h"
#include "engine/math/geo.h"
#include "tools/compare/json_file.h"
#include "tools/compare/text_table.h"

namespace vinerow::tools {
namespace {

using Json = nlohmann::ordered_json;

struct MapRows {
  std::optional<GeoOrigin> origin;
  std::vector<MapRow> rows;
};

double map_number(const Json& json, const char* key, const std::filesystem::path& file) {
  const auto found = json.find(key);
  if (found == json.end() || !found->is_number()) {
    throw ConfigError(fmt::format("{}: must have a number '{}' here: {}", file.string(), key,
                                  printable(json.dump().substr(0, 80))));
  }
  return found->get<double>();
}

Eigen::Vector3d map_point(const Json& json, const char* key, const std::filesystem::path& file) {
  const auto found = json.find(key);
  const bool good = found != json.end() && found->is_array() && found->size() == 3 &&
                    std::all_of(found->begin(), found->end(),
                                [](const Json& value) { return value.is_number(); });
  if (!good) {
    throw ConfigError(
        fmt::format("{}: must have a point '{}' of three numbers in each row", file.string(), key));
  }
  return {(*found)[0].get<double>(), (*found)[1].get<double>(), (*found)[2].get<double>()};
}

MapRows read_map_rows(const std::filesystem::path& folder) {
  const std::filesystem::path file = folder / "report.json";
  const Json report = read_json_file(file);
  if (!report.contains("rows") || !report["rows"].is_array()) {
    throw ConfigError(
        fmt::format("{}: has no list 'rows', so it is not the report of a map", file.string()));
  }
  MapRows map;
  for (const Json& json : report["rows"]) {
    MapRow row;
    row.row = static_cast<int>(map_number(json, "row", file));
    row.first_W = map_point(json, "first_m", file);
    row.last_W = map_point(json, "last_m", file);
    row.length_m = map_number(json, "length_m", file);
    row.volume_m3 = map_number(json, "volume_m3", file);
    row.top_m = map_number(json, "canopy_top_m", file);
    row.width_m = map_number(json, "canopy_width_m", file);
    map.rows.push_back(row);
  }
  const std::filesystem::path map_file = folder / "map.json";
  const Json json = read_json_file(map_file);
  if (const auto found = json.find("origin"); found != json.end() && found->is_object()) {
    GeoOrigin origin;
    origin.latitude_rad = rad_from_deg(map_number(*found, "latitude_deg", map_file));
    origin.longitude_rad = rad_from_deg(map_number(*found, "longitude_deg", map_file));
    origin.altitude_m = map_number(*found, "altitude_m", map_file);
    map.origin = origin;
  }
  return map;
}

/// Half the smallest distance between neighbouring rows of a map; 1 m if it has a single row.
double half_spacing_m(const std::vector<MapRow>& rows) {
  double min_m = 2.0;
  bool any = false;
  for (const MapRow& a : rows) {
    const Eigen::Vector2d along = (a.last_W - a.first_W).head<2>().normalized();
    for (const MapRow& b : rows) {
      const Eigen::Vector2d apart = (0.5 * (b.first_W + b.last_W) - a.first_W).head<2>();
      const double distance_m = std::abs(along.x() * apart.y() - along.y() * apart.x());
      // Closer rows are pieces of one row, not neighbours. Chosen.
      constexpr double kOneRow_m = 0.5;
      if (distance_m < kOneRow_m || (any && distance_m >= min_m)) continue;
      min_m = distance_m;
      any = true;
    }
  }
  return 0.5 * min_m;
}

/// Distance of b's middle from a's line; nullopt if the rows do not run along each other.
std::optional<double> offset_between(const MapRow& a, const MapRow& b) {
  const Eigen::Vector2d from = a.first_W.head<2>(), to = a.last_W.head<2>();
  const double length_m = (to - from).norm();
  const Eigen::Vector2d course_b = (b.last_W - b.first_W).head<2>();
  const double length_b_m = course_b.norm();
  if (length_m <= 0.0 || length_b_m <= 0.0) return std::nullopt;
  const Eigen::Vector2d along = (to - from) / length_m;
  const double kMinCosine = std::cos(rad_from_deg(15.0));
  if (std::abs(along.dot(course_b)) < kMinCosine * length_b_m) return std::nullopt;
  const double s0 = along.dot(b.first_W.head<2>() - from);
  const double s1 = along.dot(b.last_W.head<2>() - from);
  const double shared_m = std::min(length_m, std::max(s0, s1)) - std::max(0.0, std::min(s0, s1));
  constexpr double kMinShared = 0.5;
  if (shared_m < kMinShared * std::min(length_m, length_b_m)) return std::nullopt;
  const Eigen::Vector2d apart = 0.5 * (b.first_W + b.last_W).head<2>() - from;
  return std::abs(along.x() * apart.y() - along.y() * apart.x());
}

struct Candidate {
  double offset_m = 0.0;
  std::size_t a = 0, b = 0;
};

std::vector<ComparedMapRow> match_rows(const std::vector<MapRow>& a, const std::vector<MapRow>& b,
                                       double reach_m) {
  std::vector<Candidate> candidates;
  for (std::size_t i = 0; i < a.size(); ++i) {
    for (std::size_t j = 0; j < b.size(); ++j) {
      const auto offset_m = offset_between(a[i], b[j]);
      if (offset_m && *offset_m <= reach_m) candidates.push_back({*offset_m, i, j});
    }
  }
  std::stable_sort(candidates.begin(), candidates.end(),
                   [](const Candidate& x, const Candidate& y) { return x.offset_m < y.offset_m; });
  std::vector<ComparedMapRow> rows;
  for (const MapRow& row : a) rows.push_back({row, std::nullopt, 0.0});
  std::vector<bool> is_matched(b.size(), false);
  for (const Candidate& candidate : candidates) {
    if (rows[candidate.a].b || is_matched[candidate.b]) continue;
    is_matched[candidate.b] = true;
    rows[candidate.a].b = b[candidate.b];
    rows[candidate.a].offset_m = candidate.offset_m;
  }
  for (std::size_t j = 0; j < b.size(); ++j) {
    if (!is_matched[j]) rows.push_back({std::nullopt, b[j], 0.0});
  }
  return rows;
}

std::string volume_change(double from_m3, double to_m3) {
  return from_m3 > 0.0 ? fmt::format("{:+.1f} %", 100.0 * (to_m3 - from_m3) / from_m3) : "";
}

double total_m3(const MapComparison& comparison, bool of_a) {
  double sum_m3 = 0.0;
  for (const ComparedMapRow& row : comparison.rows) {
    // Only rows that both maps have: a row in one map alone is not a change of the canopy.
    if (row.a && row.b) sum_m3 += of_a ? row.a->volume_m3 : row.b->volume_m3;
  }
  return sum_m3;
}

Json row_json(const ComparedMapRow& row) {
  Json json;
  const auto put = [&json](const char* key, const std::optional<MapRow>& of,
                           double MapRow::*member) {
    json[key] = of ? Json((*of).*member) : Json(nullptr);
  };
  json["row_a"] = row.a ? Json(row.a->row) : Json(nullptr);
  json["row_b"] = row.b ? Json(row.b->row) : Json(nullptr);
  put("volume_a_m3", row.a, &MapRow::volume_m3);
  put("volume_b_m3", row.b, &MapRow::volume_m3);
  const bool both = row.a && row.b;
  const double change_m3 = both ? row.b->volume_m3 - row.a->volume_m3 : 0.0;
  json["volume_change_m3"] = both ? Json(change_m3) : Json(nullptr);
  json["volume_change_share"] =
      both && row.a->volume_m3 > 0.0 ? Json(change_m3 / row.a->volume_m3) : Json(nullptr);
  put("canopy_top_a_m", row.a, &MapRow::top_m);
  put("canopy_top_b_m", row.b, &MapRow::top_m);
  put("canopy_width_a_m", row.a, &MapRow::width_m);
  put("canopy_width_b_m", row.b, &MapRow::width_m);
  put("length_a_m", row.a, &MapRow::length_m);
  put("length_b_m", row.b, &MapRow::length_m);
  json["offset_m"] = both ? Json(row.offset_m) : Json(nullptr);
  return json;
}

}  // namespace

MapComparison compare_maps(const std::filesystem::path& a, const std::filesystem::path& b,
                           double reach_m) {
  MapRows first = read_map_rows(a), second = read_map_rows(b);
  if (first.origin.has_value() != second.origin.has_value()) {
    const auto& with = first.origin ? a : b;
    const auto& without = first.origin ? b : a;
    throw ConfigError(
        fmt::format("{} has a geographic origin and {} does not, so the relative position of their "
                    "rows is unknown",
                    with.string(), without.string()));
  }
  if (first.origin) {
    const LocalFrame frame_a(*first.origin), frame_b(*second.origin);
    for (MapRow& row : second.rows) {
      row.first_W = frame_a.to_local(frame_b.to_geodetic(row.first_W));
      row.last_W = frame_a.to_local(frame_b.to_geodetic(row.last_W));
    }
  }
  MapComparison comparison{a.string(), b.string(), first.origin, {}};
  comparison.rows =
      match_rows(first.rows, second.rows, reach_m > 0.0 ? reach_m : half_spacing_m(first.rows));
  return comparison;
}

std::string comparison_text(const MapComparison& comparison) {
  std::vector<std::vector<std::string>> table = {{"row in A", "in B", "volume A m3", "volume B m3",
                                                  "B - A m3", "change", "top A m", "top B m",
                                                  "offset m"}};
  std::size_t matched = 0;
  for (const ComparedMapRow& row : comparison.rows) {
    const auto number = [](const std::optional<MapRow>& of, double MapRow::*member) {
      return of ? fmt::format("{:.2f}", (*of).*member) : std::string("-");
    };
    const bool both = row.a && row.b;
    matched += both ? 1 : 0;
    table.push_back({row.a ? fmt::format("{}", row.a->row) : "-",
                     row.b ? fmt::format("{}", row.b->row) : "-", number(row.a, &MapRow::volume_m3),
                     number(row.b, &MapRow::volume_m3),
                     both ? fmt::format("{:+.2f}", row.b->volume_m3 - row.a->volume_m3) : "",
                     both ? volume_change(row.a->volume_m3, row.b->volume_m3) : "",
                     number(row.a, &MapRow::top_m), number(row.b, &MapRow::top_m),
                     both ? fmt::format("{:.2f}", row.offset_m) : ""});
  }
  const double a_m3 = total_m3(comparison, true), b_m3 = total_m3(comparison, false);
  return fmt::format(
             "A  {}\nB  {}\n\n{}\n{} rows in both: A {:.1f} m3, B {:.1f} m3 ({:+.1f} m3, {})",
             printable(comparison.folder_a), printable(comparison.folder_b), text_table(table),
             matched, a_m3, b_m3, b_m3 - a_m3,
             a_m3 > 0.0 ? volume_change(a_m3, b_m3) : "no volume") +
         (matched == comparison.rows.size()
              ? "\n"
              : fmt::format("; {} in only one map\n", comparison.rows.size() - matched));
}

nlohmann::ordered_json comparison_json(const MapComparison& comparison) {
  Json json = {{"map_a", comparison.folder_a}, {"map_b", comparison.folder_b}};
  json["rows"] = Json::array();
  for (const ComparedMapRow& row : comparison.rows) json["rows"].push_back(row_json(row));
  json["volume_of_rows_in_both_a_m3"] = total_m3(comparison, true);
  json["volume_of_rows_in_both_b_m3"] = total_m3(comparison, false);
  return json;
}

std::string comparison_geojson(const MapComparison& comparison) {
  if (!comparison.origin) {
    throw ConfigError(
        fmt::format("{} has no geographic origin, so its rows cannot be written as "
                    "GeoJSON; --json prints the numbers",
                    comparison.folder_a));
  }
  const LocalFrame frame(*comparison.origin);
  const auto position = [&](const Eigen::Vector3d& p_W) {
    const Geodetic place = frame.to_geodetic(p_W);
    // 1e-9 deg is 0.1 mm. Division by a whole number gives the double nearest to the decimal.
    const auto rounded = [](double value, double parts) {
      return std::round(value * parts) / parts;
    };
    return Json::array({rounded(deg_from_rad(place.longitude_rad), 1e9),
                        rounded(deg_from_rad(place.latitude_rad), 1e9),
                        rounded(place.altitude_m, 1e3)});
  };
  Json collection = {{"type", "FeatureCollection"}, {"features", Json::array()}};
  for (const ComparedMapRow& row : comparison.rows) {
    const MapRow& drawn = row.a ? *row.a : *row.b;
    Json line = {{"type", "LineString"}};
    line["coordinates"] = Json::array({position(drawn.first_W), position(drawn.last_W)});
    collection["features"].push_back(
        {{"type", "Feature"}, {"properties", row_json(row)}, {"geometry", line}});
  }
  return collection.dump(1) + "\n";
}

}  // namespace vinerow::tools
