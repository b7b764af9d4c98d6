#pragma once
/// Two maps of one vineyard side by side, row by row: what grew between two dates.

#include <Eigen/Core>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "engine/math/geo_origin.h"

namespace vinerow::tools {

/// A row as report.json of a map has it.
struct MapRow {
  int row = 0;
  Eigen::Vector3d first_W = {0, 0, 0}, last_W = {0, 0, 0};  ///< in the first map's frame
  double length_m = 0.0, volume_m3 = 0.0, top_m = 0.0, width_m = 0.0;
};

struct ComparedMapRow {
  std::optional<MapRow> a, b;  ///< one is absent where only one map has the row
  double offset_m = 0.0;       ///< of the middle of b from the line of a
};

struct MapComparison {
  std::string folder_a, folder_b;
  std::optional<GeoOrigin> origin;
  std::vector<ComparedMapRow> rows;  ///< in the order of the first map
};

/// Rows are the same where they lie along each other: the middle of one within `reach_m` of the
/// other's line, courses within 15 deg, half of the shorter beside the longer. The nearest first.
/// @param reach_m  0: half the distance between the first map's rows
/// @throws ConfigError "maps/x: holds no report.json, ..." | where one map has an origin and the
/// other has none
MapComparison compare_maps(const std::filesystem::path& a, const std::filesystem::path& b,
                           double reach_m);

std::string comparison_text(const MapComparison& comparison);
nlohmann::ordered_json comparison_json(const MapComparison& comparison);
/// Lines of the rows in WGS84 with what changed. @throws ConfigError where the maps have no origin
std::string comparison_geojson(const MapComparison& comparison);

}  // namespace vinerow::tools
