#pragma once
/// Files map.json and report.json of a Vinerow map's folder (map_folder.h).
///
/// Lengths are in m in W, angles in degrees, as the keys show; map_json_schema() lists every key.
/// Numbers are written with the fewest digits that read back to the same bits.

#include <filesystem>
#include <string>

#include "worlds/mapping/model/cloud_map.h"

namespace vinerow::mapping {

inline constexpr int kMapVersion = 1;  ///< of the folder's format

/// Contents of map.json about the other files.
struct MapFiles {
  struct Grid {
    int columns = 0, rows = 0;
    double cell_m = 0.0;
    Eigen::Vector2d corner_W = {0, 0};
  };
  std::optional<Grid> terrain;             ///< terrain.tif, samples
  std::optional<Grid> occupancy;           ///< occupancy.yaml, cells
  std::vector<std::pair<int, int>> hulls;  ///< row and number of its meshes, if any
};

/// Everything except meshes, heights and grid cells, which are separate files, and phases, which
/// differ from run to run. @pre check_map(map) passed
std::string map_to_json(const CloudMap& map);

/// The report alone.
std::string report_to_json(const CloudMapReport& report);

/// @param text  of a map.json. @param file  named in errors
/// @returns a map without meshes, heights and cells. @throws ConfigError in one sentence: no JSON,
/// of another version, a key that is missing, of the wrong kind or out of range
CloudMap map_from_json(const std::string& text, const std::filesystem::path& file, MapFiles& files);

/// Checks the conditions for a map to be written or used: rows with unique ids, lines of at least
/// two distinct points, sizes > 0, finite numbers, meshes of existing rows.
/// @param name  subject of the error sentence, like "map 'MAP'". @throws ConfigError
void check_map(const CloudMap& map, const std::string& name);

/// JSON Schema (draft 2020-12) of map.json and of report.json.
std::string map_json_schema();
std::string report_json_schema();

}  // namespace vinerow::mapping
