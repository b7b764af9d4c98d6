#pragma once
/// Comparison of two maps of one vineyard, row by row, such as growth between two dates.

#include <Eigen/Core>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "engine/math/geo_origin.h"

namespace vinerow::tools {

/// Row of a map, from its report.json.
struct MapRow {
  int row = 0;
  Eigen::Vector3d first_W = {0, 0, 0}, last_W = {0, 0, 0};  ///< in the first map's frame
  double length_m = 0.0, volume_m3 = 0.0, top_m = 0.0, width_m = 0.0;
};

struct ComparedMapRow {
  std::optional<MapRow> a, b;  ///< one is absent if only the other map has the row
  double offset_m = 0.0;       ///< distance of the middle of b from the line of a
};

struct MapComparison {
  std::string folder_a, folder_b;
  std::optional<GeoOrigin> origin;
  std::vector<ComparedMapRow> rows;  ///< in the order of the first map
};

/// Compares two maps. Rows are the same if they run along each other: the middle of one is within
/// `reach_m` of the other's line, the directions differ by at most 15 deg, and at least half of the
/// shorter is alongside the longer. The nearest pairs are matched first.
/// @param reach_m  0: half the row spacing of the first map
/// @throws ConfigError if a report.json is missing or invalid, or only one map has an origin
MapComparison compare_maps(const std::filesystem::path& a, const std::filesystem::path& b,
                           double reach_m);

std::string comparison_text(const MapComparison& comparison);
nlohmann::ordered_json comparison_json(const MapComparison& comparison);
/// Lines of the rows in WGS84 with their changes. @throws ConfigError if the maps have no origin
std::string comparison_geojson(const MapComparison& comparison);

}  // namespace vinerow::tools
