#pragma once
/// Maps as `vinerow map` makes them, here from the truth of small worlds, and folders they are kept
/// in.

#include <unistd.h>

#include <filesystem>

#include "tests/worlds/mapping/map_fixture.h"
#include "worlds/mapping/folder/map_folder.h"

namespace vinerow::test {

/// Rows, hulls and accuracy of a survey of the true canopy, the world's ground and grid; a report
/// with a number of its own in every field.
inline const mapping::CloudMap& map_of_world(const std::string& type) {
  static std::map<std::string, mapping::CloudMap> maps;
  mapping::CloudMap& map = maps[type];
  if (!map.map.rows.empty()) return map;
  const SurveyedWorld& world = surveyed_world(type);
  map.map = *world_registry().make_map("row_mesh", map_parameters("row_mesh"), world.context());
  map.map.terrain = world.model->terrain;
  map.origin = world.model->origin;
  map.has_origin = true;
  mapping::CloudMapReport& report = map.report;
  report.file = "flight \"one\"/parcel_ü.las";
  report.format = "LAS 1.4";
  report.crs = "EPSG:32632";
  double next = 0.1;
  for (std::int64_t* count : {&report.cloud_bytes, &report.points, &report.not_finite,
                              &report.ground_points, &report.low_points, &report.canopy_points,
                              &report.other_points, &report.triangles, &report.mesh_bytes}) {
    *count = static_cast<std::int64_t>(1e9 * (next += 0.7));
  }
  for (double* number :
       {&report.density_per_m2, &report.noise_m, &report.bearing_deg, &report.spacing_m,
        &report.spacing_std_m, &report.canopy_top_m, &report.canopy_width_m, &report.volume_m3,
        &report.seen_volume_m3}) {
    *number = next += 1.0 / 3.0;
  }
  report.containment = 0.987654321;
  report.reduction = 0.9876;
  report.notes = {"First sentence.", "Second <sentence> & \"more\"."};
  for (const PlantRow& row : map.map.rows) {
    mapping::MappedRowFigures figures;
    figures.row = row.id;
    figures.first_W = row.line_W.front();
    figures.last_W = row.line_W.back();
    for (double* number : {&figures.length_m, &figures.bearing_deg, &figures.spacing_m,
                           &figures.canopy_base_m, &figures.canopy_top_m, &figures.canopy_width_m,
                           &figures.volume_m3, &figures.seen_volume_m3}) {
      *number = next += 1.0 / 7.0;
    }
    figures.containment = 0.98 + 0.001 * row.id;
    figures.points = 1000 + row.id;
    figures.triangles = 100 + row.id;
    figures.gaps_m = {{1.0 / 3.0, 2.0}, {5.0, 6.1}};
    report.rows.push_back(figures);
  }
  return map;
}

/// A folder under the system's temporary one, gone when the process ends.
class MapFolders {
 public:
  MapFolders()
      : path_(std::filesystem::temp_directory_path() /
              ("vinerow_maps_" + std::to_string(::getpid()))) {
    std::filesystem::remove_all(path_);
  }
  ~MapFolders() { std::filesystem::remove_all(path_); }
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

/// Where map_of_world() is saved.
inline std::string folder_of_world(const std::string& type) {
  static const MapFolders folders;
  const std::filesystem::path folder = folders.path() / type;
  if (!std::filesystem::exists(folder)) mapping::save_map(map_of_world(type), folder);
  return folder.string();
}

}  // namespace vinerow::test
