#include "worlds/mapping/folder/map_folder.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "engine/core/error.h"
#include "engine/core/files.h"
#include "engine/core/whole_file.h"
#include "engine/io/geo/height_raster.h"
#include "engine/io/grids/ros_map.h"
#include "worlds/mapping/folder/map_files.h"
#include "worlds/mapping/folder/map_gis.h"
#include "worlds/mapping/folder/map_json.h"

namespace vinerow::mapping {
namespace {

namespace fs = std::filesystem;

/// Rows with meshes and how many.
std::vector<std::pair<int, int>> count_hulls(const std::vector<RowMesh>& meshes) {
  std::map<int, int> hulls;
  for (const RowMesh& mesh : meshes) ++hulls[mesh.row];
  return {hulls.begin(), hulls.end()};
}

void load_all_meshes(const fs::path& folder, const MapFiles& files, CloudMap& map) {
  if (files.hulls.empty()) return;
  map.map.meshes = load_meshes((folder / "meshes").string());
  const auto found = count_hulls(map.map.meshes);
  const auto count_of = [](const std::vector<std::pair<int, int>>& hulls, int row) {
    const auto at = std::find_if(hulls.begin(), hulls.end(),
                                 [row](const auto& entry) { return entry.first == row; });
    return at == hulls.end() ? 0 : at->second;
  };
  for (const PlantRow& row : map.map.rows) {
    if (count_of(found, row.id) == count_of(files.hulls, row.id)) continue;
    throw ConfigError(
        fmt::format("map '{}': map.json counts {} meshes of row {}, the folder '{}' holds {}",
                    folder.string(), count_of(files.hulls, row.id), row.id,
                    (folder / "meshes").string(), count_of(found, row.id)));
  }
}

/// @param file  "terrain.tif"
void check_size(const fs::path& folder, const char* file, const MapFiles::Grid& expected,
                int columns, int rows, double cell_m, const Eigen::Vector2d& corner_W) {
  const double near = 1e-6 * expected.cell_m;
  if (columns == expected.columns && rows == expected.rows &&
      std::abs(cell_m - expected.cell_m) <= near &&
      (corner_W - expected.corner_W).norm() <= 1e-6 + 1e-9 * expected.corner_W.norm()) {
    return;
  }
  throw ConfigError(fmt::format(
      "map '{}': {} has {} x {} places of {:g} m from ({:.3f}, {:.3f}), by map.json they are {} x "
      "{} of {:g} m from ({:.3f}, {:.3f})",
      folder.string(), file, columns, rows, cell_m, corner_W.x(), corner_W.y(), expected.columns,
      expected.rows, expected.cell_m, expected.corner_W.x(), expected.corner_W.y()));
}

}  // namespace

fs::path block_folder(const fs::path& folder, int block) {
  return folder / fmt::format("block_{}", block);
}

int count_blocks(const CloudMap& map) {
  std::set<int> blocks;
  for (const MappedRowFigures& row : map.report.rows) blocks.insert(row.block);
  return static_cast<int>(blocks.size());
}

void save_map(const CloudMap& map, const fs::path& folder) {
  check_map(map, fmt::format("map '{}'", folder.string()));
  std::error_code error;
  // Of an earlier map, until the first number that it did not have.
  for (int k = 0; fs::exists(block_folder(folder, k) / "map.json", error); ++k) {
    fs::remove_all(block_folder(folder, k), error);
  }
  for (const CloudMap& block : map.blocks) {
    save_map(block, block_folder(folder, block.report.rows.front().block));
  }
  fs::create_directories(folder, error);
  if (error) {
    throw ConfigError(fmt::format("folder '{}' cannot be created for the map: {}", folder.string(),
                                  error.message()));
  }
  // Until map.json is there again the folder is no map.
  for (const char* file :
       {"map.json", "report.json", "terrain.tif", "occupancy.yaml", "occupancy.pgm", "rows.geojson",
        "rows.csv", "points.json", "points.classes", "gis/dtm.tif", "gis/dsm.tif", "gis/chm.tif",
        "gis/map.gpkg"}) {
    fs::remove(folder / file, error);
  }
  save_meshes(map.map.meshes, (folder / "meshes").string());
  if (map.map.terrain) {
    io::write_height_raster(*map.map.terrain,
                            map.has_origin ? std::optional(map.origin) : std::nullopt,
                            folder / "terrain.tif");
  }
  if (!map.map.occupancy.empty()) io::save_ros_map(map.map.occupancy, folder / "occupancy.yaml");
  if (map.has_origin) write_whole_file(folder / "rows.geojson", map_to_geojson(map));
  write_whole_file(folder / "rows.csv", rows_to_csv(map));
  write_whole_file(folder / "report.json", report_to_json(map.report));
  write_whole_file(folder / "map.json", map_to_json(map));
}

CloudMap load_map(const fs::path& folder) {
  const fs::path file = folder / "map.json";
  std::error_code error;
  if (!fs::is_regular_file(file, error)) {
    throw ConfigError(fmt::format("'{}' holds no map: there is no map.json", folder.string()));
  }
  MapFiles files;
  CloudMap map = map_from_json(read_bytes(file).value_or(""), file, files);
  load_all_meshes(folder, files, map);
  if (files.terrain) {
    HeightField terrain = io::read_height_raster(folder / "terrain.tif");
    check_size(folder, "terrain.tif", *files.terrain, terrain.columns, terrain.rows, terrain.cell_m,
               terrain.corner_W);
    terrain.cell_m = files.terrain->cell_m;
    terrain.corner_W = files.terrain->corner_W;
    map.map.terrain = std::move(terrain);
  }
  if (files.occupancy) {
    map.map.occupancy = io::load_ros_map(folder / "occupancy.yaml").grid;
    const OccupancyGrid& grid = map.map.occupancy;
    check_size(folder, "occupancy.yaml", *files.occupancy, grid.columns, grid.rows, grid.cell_m,
               grid.corner_W);
  }
  check_map(map, fmt::format("map '{}'", folder.string()));
  return map;
}

}  // namespace vinerow::mapping
