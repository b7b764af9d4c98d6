#pragma once
/// Picture files of maps, for `vinerow map` and for the jobs of a run.

#include <filesystem>
#include <string>
#include <vector>

#include "engine/run/run.h"
#include "engine/scenario/scenario.h"
#include "worlds/mapping/grid/occupancy.h"
#include "worlds/mapping/model/cloud_map.h"
#include "worlds/mapping/model/parcel_cloud.h"

namespace vinerow::tools {

/// Writes top.png, classes.png, mesh.png and, if the map has a grid, grid.png.
/// @param cloud  has classes  @param folder  created if missing
/// @returns the files, in this order. @throws ConfigError if they cannot be written
std::vector<std::filesystem::path> write_map_pictures(const mapping::CloudMap& map,
                                                      const mapping::ParcelCloud& cloud,
                                                      const mapping::OccupancyOptions& options,
                                                      const std::string& title,
                                                      const std::filesystem::path& folder);

/// Writes the same for every map that a job of a run made from a cloud, into the folder of its
/// product, from the points kept there (map_points.h) and the cloud that the job took. A map
/// without points has no pictures. @throws ConfigError if files of a product have changed
std::vector<std::filesystem::path> write_job_pictures(const scenario::Scenario& scenario,
                                                      const run::RunResult& result);

}  // namespace vinerow::tools
